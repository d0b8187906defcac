"""The tool from end to end, as a user runs it."""

import json
import os
import unittest
from unittest import mock

import numpy as np
from support import TOOL, FolderTest, about, moved, run_tool, wandering, write_tum
from vins_evaluation import command_line


class CommandLineTest(FolderTest):

    def setUp(self):
        super().setUp()
        truth = wandering(400)
        write_tum(self.path("truth.txt"), truth)
        turned = moved(truth, about([0, 0, 1], 30.0), np.array([1.0, 2.0, 3.0]))
        write_tum(self.path("a.txt"), turned)
        write_tum(self.path("b.txt"), moved(turned, about([0, 0, 1], 0.0), np.zeros(3), 1.1))

    def run_here(self, *arguments, **options):
        return run_tool(*arguments, cwd=self.folder, **options)

    def assert_fails(self, code, pattern, *arguments):
        done = self.run_here(*arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertRegex(done.stderr, pattern)
        self.assertNotIn("Traceback", done.stderr)
        self.assertEqual(done.stdout, "")

    def test_ctrl_c_leaves_no_half_written_report(self):
        report = self.path("r.json")
        with mock.patch.object(command_line.os, "replace", side_effect=KeyboardInterrupt), \
                mock.patch("builtins.print"):
            code = command_line.main([self.path("truth.txt"), self.path("a.txt"), "--json", report])
        self.assertEqual(code, 130)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.txt", "b.txt", "truth.txt"])

    def test_two_estimates_with_all_reports(self):
        done = self.run_here("truth.txt", "a.txt", "b.txt", "--names", "good", "10 % too large",
                             "--json", "r.json", "--html", "r.html", "--distances", "1", "3")
        self.assertEqual(done.returncode, 0, done.stderr)
        # Matplotlib may have something to say there about its font cache.
        self.assertNotIn("evaluate_trajectory:", done.stderr)
        self.assertIn("10 % too large", done.stdout)
        with open(self.path("r.json"), encoding="utf-8") as file:
            good, large = json.load(file)["estimates"]
        self.assertLess(good["ate_m"]["rmse"], 1e-8)
        self.assertAlmostEqual(large["scale_error_percent"], 10.0, places=6)
        self.assertEqual([rpe["distance_m"] for rpe in large["rpe"]], [1.0, 3.0])
        with open(self.path("r.html"), encoding="utf-8") as file:
            page = file.read()
        self.assertEqual(page.count("<svg"), 5)
        self.assertNotIn("http", page)
        self.assertIn("--names good &#x27;10 % too large&#x27;", page)
        self.assertNotIn(self.folder, page)
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["a.txt", "b.txt", "r.html", "r.json", "truth.txt"])

    def test_options_reach_the_evaluation(self):
        done = self.run_here("truth.txt", "a.txt", "--align", "sim3", "--max-gap", "2",
                             "--max-truth-gap", "0.3", "--start", "1", "--duration", "20",
                             "--t-offset", "-0.05", "--json", "r.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path("r.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertEqual(report["settings"], {
            "align": "sim3", "max_gap_s": 2.0, "max_truth_gap_s": 0.3, "start_s": 1.0,
            "duration_s": 20.0, "time_offset_s": -0.05})
        self.assertAlmostEqual(report["ground_truth"]["duration_s"], 20.0)

    def test_estimates_may_follow_options(self):
        done = self.run_here("truth.txt", "--align", "none", "a.txt", "b.txt")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r" a +b\n")

    def test_it_runs_through_a_link(self):
        os.makedirs(self.path("bin"))
        link = self.path("bin/evaluate")
        os.symlink(os.path.relpath(TOOL, self.path("bin")), link)
        done = self.run_here("truth.txt", "a.txt", tool=link)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("Position error", done.stdout)

    def test_help_tells_the_options(self):
        done = self.run_here("--help")
        self.assertEqual(done.returncode, 0)
        for option in ("--align", "--distances", "--max-gap", "--json", "--html", "FILE.bag:"):
            self.assertIn(option, done.stdout)

    def test_warnings_do_not_stop_it(self):
        with open(self.path("a.txt"), encoding="utf-8") as file:
            lines = file.readlines()
        self.file("twice.txt", "".join(lines[:5] + [lines[4]] + lines[5:]))
        done = self.run_here("truth.txt", "twice.txt")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, "^evaluate_trajectory: warning: twice.txt: dropped 1 .*"
                                      "line 6\n$")

    def test_bad_input_ends_with_1_and_names_the_place(self):
        self.file("bad.txt", "1 0 0 0 0 0 0 1\n2 0 nan 0 0 0 0 1\n")
        self.file("late.txt", "9000 0 0 0 0 0 0 1\n9001 1 0 0 0 0 0 1\n")
        self.assert_fails(1, "error: bad.txt, line 2: position", "truth.txt", "bad.txt")
        self.assert_fails(1, "error: bad.txt, line 2: position", "bad.txt", "a.txt")
        self.assert_fails(1, "error: late.txt: 0 of its 2 poses", "truth.txt", "late.txt")
        self.assert_fails(1, "error: no.txt: cannot read it", "truth.txt", "no.txt")
        self.assert_fails(1, "error: no.bag", "truth.txt", "no.bag:/odometry")

    def test_a_report_that_cannot_be_written(self):
        os.makedirs(self.path("folder"))
        for target in ("no_such_folder/r.json", "folder"):
            done = self.run_here("truth.txt", "a.txt", "--json", target)
            self.assertEqual(done.returncode, 1)
            self.assertIn("error: %s: cannot write it" % target, done.stderr)
        self.assertNotIn("folder.part", os.listdir(self.folder))

    def test_wrong_usage_ends_with_2(self):
        both = ("truth.txt", "a.txt")
        self.assert_fails(2, "required: .*ESTIMATE", "truth.txt")
        self.assert_fails(2, "2 --names for 1 estimates", *both, "--names", "x", "y")
        self.assert_fails(2, "--align: invalid choice: 'yaw'", *both, "--align", "yaw")
        self.assert_fails(2, "--max-gap: '0' is not above 0", *both, "--max-gap", "0")
        self.assert_fails(2, "--start: '-1' is below 0", *both, "--start", "-1")
        self.assert_fails(2, "--t-offset: 'nan' is not finite", *both, "--t-offset", "nan")
        self.assert_fails(2, "--distances: .*'far'", *both, "--distances", "far")


if __name__ == "__main__":
    unittest.main()
