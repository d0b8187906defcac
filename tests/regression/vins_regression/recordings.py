"""The fixed set of recordings that every version of the code is measured on."""

import collections
import os
import unittest

from vins_regression import files, simulated_bags

# What run_bag takes; ground_truth is None where the recording has it.
Source = collections.namedtuple("Source", "config path ground_truth")


class Recording:
    """One of the set: its name, what it is in words, and how to come by it.

    Args:
        prepare: called without arguments; a Source, or raises unittest.SkipTest where it needs
            real data that is not there.
    """

    def __init__(self, name, description, prepare):
        self.name = name
        self.description = description
        self._prepare = prepare

    def prepare(self):
        """A Source, rendered where need be; None where real data is missing."""
        try:
            return self._prepare()
        except unittest.SkipTest:
            return None


def _simulated(name, *arguments):
    bag = simulated_bags.simulated((name, list(arguments)))
    return Source(bag.rig, bag.bag, bag.ground_truth)


def _half_real(name, flight, duration):
    poses = files.real_recording(os.path.join("groundtruth", flight + ".txt"))
    imu = files.real_recording(os.path.join("recorded_imu", flight + ".csv"))
    return _simulated(name, "--trajectory", poses, "--recorded-imu", imu, "--duration", duration)


def _mh01():
    config = os.path.join(files.WORKSPACE, "config", "euroc", "euroc_config.yaml")
    return Source(config, files.real_recording("euroc_mh01_flight"), None)


ALL = (
    Recording("hall", "hall, two rounds, 60 s (simulated)",
              lambda: _simulated("hall", "--trajectory", "hall_loop", "--duration", "60",
                                 "--seed", "3")),
    Recording("fast", "room, fast rounds, 40 s (simulated)",
              lambda: _simulated("fast", "--trajectory", "fast", "--duration", "40")),
    Recording("faults", "hall with IMU gaps and a blackout, 50 s (simulated)",
              lambda: _simulated("faults50", "--trajectory", "hall_loop", "--duration", "50",
                                 "--faults")),
    Recording("v2_01", "V2_01 with its recorded IMU, images rendered, 70 s",
              lambda: _half_real("v2_01", "V2_01_easy", "70")),
    Recording("mh_05", "MH_05 with its recorded IMU, images rendered, 90 s",
              lambda: _half_real("mh_05", "MH_05_difficult", "90")),
    Recording("mh_01", "EuRoC MH_01, take-off and flight of 19 m (real)", _mh01),
)
