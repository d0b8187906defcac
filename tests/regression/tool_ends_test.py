#!/usr/bin/python3
"""How the tools end by Ctrl-C and on a full disk: soon, with a word, and with whole files only."""

import json
import os
import subprocess
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
        self._assert_whole(self._path("a/new/folder/vio_live.txt"))

    def test_run_bag_on_a_full_disk(self):
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        # Room for what it says, but not for 20 poses a second.
        tool = self._start("run_bag", bag.rig, bag.bag, "--duration", "8", "--out",
                           self._path("out"), **processes.full_disk(6000))
        self._assert_refused(tool, "cannot be written: File too large")
        self.assertEqual([name for name in paths_below(self.folder) if name.endswith(".part")], [])

    def test_run_bag_without_room_for_what_comes_last(self):
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        # Poses of 8 s take 10 kB, the page with its plots 100 kB and more; so does the ground truth
        # at the IMU's rate, but not every tenth pose of it.
        sparse = self._path("sparse.txt")
        with open(bag.ground_truth, encoding="utf-8") as all_poses:
            with open(sparse, "w", encoding="utf-8") as some_poses:
                some_poses.writelines(list(all_poses)[::10])
        for name, truth in (("report.html", sparse), ("ground_truth.txt", bag.ground_truth)):
            with self.subTest(name):
                out = self._path(name + "_missing")
                tool = self._start("run_bag", bag.rig, bag.bag, "--duration", "8", "--out", out,
                                   "--ground-truth", truth, **processes.full_disk(60000))
                self._assert_refused(tool, "run_bag: " + os.path.join(out, name))
                self.assertIn("File too large", tool.output())
                self.assertNotIn("Traceback", tool.output())
                self.assertNotIn(name, paths_below(out))
                self.assertNotIn(name + ".part", paths_below(out))
                self._assert_whole(os.path.join(out, "vio_live.txt"))

    def test_run_bag_without_room_for_what_it_says(self):
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        with open("/dev/full", "w", encoding="utf-8") as full:
            tool = subprocess.run([files.program("vins_pipeline", "run_bag"), bag.rig, bag.bag,
                                   "--duration", "8", "--out", self._path("out")], stdout=full,
                                  stderr=subprocess.PIPE, text=True, timeout=120, check=False)
        self.assertEqual(tool.returncode, 1, tool.stderr)
        self.assertIn("run_bag: standard output: cannot be written", tool.stderr)
        self._assert_whole(self._path("out/vio_live.txt"))

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

    def _assert_whole(self, poses):
        with open(poses, encoding="utf-8") as file:
            lines = file.read().splitlines()
        self.assertGreater(len(lines), 50)
        self.assertEqual({len(line.split()) for line in lines}, {8})

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
