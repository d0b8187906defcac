#!/usr/bin/python3
"""How the tools end by Ctrl-C and on a full disk: soon, with a word, and with whole files only."""

import json
import os
import time
import unittest

from vins_regression import files, processes, simulated_bags
from vins_regression.processes_case import ProcessCase


def paths_below(folder):
    """All files in a folder and below, by their paths from there."""
    return sorted(os.path.relpath(os.path.join(place, name), folder)
                  for place, _, names in os.walk(folder) for name in names)


class ToolEndsTest(ProcessCase):
    """simulate_bag, asl_to_bag and run_bag."""

    def test_simulate_bag_interrupted(self):
        tool = self._start("simulate_bag", "-o", self._path("new/s.bag"), "--duration", "60")
        self._wait_for_file("new/s.bag.part", tool)
        self._assert_interrupted(tool)
        self.assertEqual(paths_below(self.folder), [])

    def test_simulate_bag_on_a_full_disk(self):
        # Full at once, but for the room that the message needs, and full in the midst of an image.
        for left in (4000, 100000):
            tool = self._start("simulate_bag", "-o", self._path("s.bag"), "--trajectory", "hover",
                               "--duration", "1", "--rate", "4", **processes.full_disk(left))
            self._assert_refused(tool, "s.bag: cannot be written")
            self.assertEqual(paths_below(self.folder), [])

    def test_asl_to_bag_interrupted(self):
        flight = files.real_recording("euroc_mh01_flight")
        tool = self._start("asl_to_bag", flight, self._path("new/mh01.bag"))
        self._wait_for_file("new/mh01.bag.part", tool)
        self._assert_interrupted(tool)
        self.assertEqual(paths_below(self.folder), [])

    def test_asl_to_bag_on_a_full_disk(self):
        flight = files.real_recording("euroc_mh01_flight")
        tool = self._start("asl_to_bag", flight, self._path("mh01.bag"),
                           **processes.full_disk(5000000))
        self._assert_refused(tool, "mh01.bag: cannot be written")
        self.assertEqual(paths_below(self.folder), [])

    def test_run_bag_interrupted(self):
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        tool = self._start("run_bag", bag.rig, bag.bag, "--out", self._path("a/new/folder"))
        self.assertTrue(tool.wait_for_word("20 %", 60.0), tool.output())
        self._assert_interrupted(tool)
        written = paths_below(self._path("a/new/folder"))
        self.assertEqual(written, ["estimator.csv", "events.csv", "loop_final.txt", "loop_live.txt",
                                   "timing.json", "tracker.csv", "vins_result_loop.csv",
                                   "vins_result_no_loop.csv", "vio_live.txt"])
        with open(self._path("a/new/folder/timing.json"), encoding="utf-8") as file:
            self.assertGreater(json.load(file)["data_seconds"], 6.0)
        with open(self._path("a/new/folder/vio_live.txt"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        self.assertGreater(len(lines), 50)
        self.assertEqual({len(line.split()) for line in lines}, {8})

    def test_run_bag_on_a_full_disk(self):
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        # Room for what it says, but not for 20 poses a second.
        tool = self._start("run_bag", bag.rig, bag.bag, "--duration", "8", "--out",
                           self._path("out"), **processes.full_disk(6000))
        self._assert_refused(tool, "cannot be written: File too large")
        self.assertEqual([name for name in paths_below(self.folder) if name.endswith(".part")], [])

    def _path(self, name):
        return os.path.join(self.folder, name)

    def _start(self, tool, *arguments, **options):
        package = "vins_tests" if tool == "simulate_bag" else "vins_pipeline"
        return self.started(processes.Process([files.program(package, tool)] + list(arguments),
                                              **options))

    def _wait_for_file(self, name, tool):
        end = time.monotonic() + 60.0
        while not os.path.exists(self._path(name)):
            self.assertTrue(tool.is_running() and time.monotonic() < end, tool.output())
            time.sleep(0.02)
        time.sleep(0.3)  # into the midst of writing

    def _assert_interrupted(self, tool):
        self.assertTrue(tool.is_running(), "it ended too early: " + tool.output())
        self.assert_ends(tool, code=130)
        self.assertIn("interrupted", tool.output())

    def _assert_refused(self, tool, word):
        self.assertIsNotNone(tool.wait(120.0), "still runs")
        self.assertEqual(tool.exit_code, 1, tool.output())
        self.assertIn(word, tool.output())


if __name__ == "__main__":
    unittest.main()
