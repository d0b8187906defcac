#!/usr/bin/python3
"""The live nodes and run_bag find the same poses, wherever nothing is dropped."""

import os
import subprocess
import tempfile

import numpy as np

from vins_regression import files, simulated_bags
from vins_regression.live_case import FRAME_NS, LiveCase, run

START = 1600000000 * 10**9  # of simulated bags [ns]
RATE = 0.6                  # of the playing: slow enough that nothing is dropped
# Files have nine digits behind the point; half of the last one is lost.
SAME = 1e-9


def _configuration(rig, folder, loops):
    """The rig with an estimator that looks at no clock and no queue; its path."""
    replaced = {"max_solver_time": "0", "motion_only_ba": "0",
                "loop_closure": "1" if loops else "0"}
    lines = []
    with open(rig, encoding="utf-8") as file:
        for line in file:
            key = line.split(":")[0].strip()
            lines.append("%s: %s\n" % (key, replaced.pop(key)) if key in replaced else line)
    lines += ["%s: %s\n" % item for item in replaced.items()]
    path = os.path.join(folder, "rig.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(lines)
    return path


def _poses(path):
    """{stamp in nanoseconds: position and quaternion} of a file in TUM form."""
    poses = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("#"):
                continue
            stamp, *values = line.split()
            seconds, _, nanoseconds = stamp.partition(".")
            poses[int(seconds) * 10**9 + int(nanoseconds)] = np.array(values, dtype=float)
    return poses


class LiveOfflineTest(LiveCase):
    """One flight, played through the nodes and given to run_bag."""

    def test_the_odometry_is_the_same_with_loops(self):
        listener, folder = self._both(True, 34.0)
        self.assertGreater(len(listener.loops), 0, "no loop was found live")
        self._judge_corrected(listener, os.path.join(folder, "loop_live.txt"))

    def test_the_odometry_is_the_same_without_loops(self):
        self._both(False, 15.0)

    def _both(self, loops, duration):
        """Plays, runs, and compares the odometry; the listener and run_bag's folder."""
        folder = tempfile.mkdtemp(prefix="live_offline_")
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        rig = _configuration(bag.rig, folder, loops)
        offline = os.path.join(folder, "offline")
        command = [files.program("vins_pipeline", "run_bag"), rig, bag.bag, "--out", offline,
                   "--duration", str(duration)]
        subprocess.run(command, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        listener = self.listen()
        self.start_nodes(rig)
        player = self.play(bag.bag, "--rate", str(RATE), "--duration", str(duration), loops=loops)
        end = START + int(duration * 1e9) - 3 * FRAME_NS
        self.wait_for_odometry(listener, end, duration / RATE + 40.0)
        self.wait_for_end_of(player, 20.0)
        self._compare(listener, _poses(os.path.join(offline, "vio_live.txt")))
        return listener, offline

    def _compare(self, listener, expected):
        live = {pose.stamp: np.concatenate([pose.position, pose.quaternion])
                for pose in listener.odometry}
        # The bag's last messages end the recording for run_bag, while the nodes wait for more.
        missing = [stamp for stamp in set(expected) - set(live) if stamp <= max(live)]
        self.assertEqual(missing, [], "images with a pose offline only")
        self.assertEqual(sorted(set(live) - set(expected)), [], "images with a pose live only")
        largest = max(np.abs(live[stamp] - expected[stamp]).max() for stamp in live)
        print("%d poses compared, largest difference %.1e" % (len(live), largest), flush=True)
        self.assertLessEqual(largest, SAME)

    def _judge_corrected(self, listener, path):
        """Once the graph is idle its corrections agree; it works on a thread of its own."""
        came = listener.wait_for(
            lambda: listener.corrected[-1].stamp == listener.odometry[-1].stamp, 5.0)
        self.assertTrue(came, self.said())
        expected = _poses(path)
        last = listener.corrected[-1]
        difference = np.linalg.norm(np.array(last.position) - expected[last.stamp][:3])
        print("corrected: the last pose differs by %.1e m" % difference, flush=True)
        self.assertLess(difference, 1e-3)


if __name__ == "__main__":
    run("live_offline_test", LiveOfflineTest)
