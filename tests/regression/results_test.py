#!/usr/bin/python3
"""What counts as clearly worse than the baseline, and how it is shown."""

import json
import os
import shutil
import tempfile
import unittest

from vins_regression import results

BASELINE = {"ate_m": 0.1, "loop_ate_m": 0.05, "scale_error_percent": -0.2, "initialised_s": 3.0,
            "completeness_percent": 95.0, "frame_ms": 10.0, "loops": 20}


def worse_with(**changes):
    """Keys of what is worse than BASELINE after some changes to it."""
    return [figure.key for figure in results.worse(dict(BASELINE, **changes), BASELINE)]


class WorseTest(unittest.TestCase):
    """The tolerances that --help states."""

    def test_the_same_is_not_worse(self):
        self.assertEqual(worse_with(), [])

    def test_within_and_beyond_each_tolerance(self):
        for key, within, beyond in (("ate_m", 0.134, 0.136), ("loop_ate_m", 0.072, 0.073),
                                    ("scale_error_percent", 0.49, -0.51),
                                    ("initialised_s", 3.9, 4.1),
                                    ("completeness_percent", 93.1, 92.9),
                                    ("frame_ms", 16.9, 17.1), ("loops", 14, 13)):
            with self.subTest(key):
                self.assertEqual(worse_with(**{key: within}), [])
                self.assertEqual(worse_with(**{key: beyond}), [key])

    def test_better_is_not_worse(self):
        self.assertEqual(worse_with(ate_m=0.01, loops=40, frame_ms=1.0, completeness_percent=99.0,
                                    initialised_s=0.5, scale_error_percent=0.0), [])

    def test_a_figure_that_is_lost_is_worse(self):
        self.assertEqual(worse_with(ate_m=None), ["ate_m"])

    def test_what_the_baseline_lacks_is_not_judged(self):
        self.assertEqual(results.worse(BASELINE, {}), [])
        self.assertEqual(results.worse(BASELINE, {"ate_m": None}), [])


class TablesTest(unittest.TestCase):
    """What a person sees."""

    def test_a_worse_figure_is_marked(self):
        text = results.text_table([("hall", dict(BASELINE, ate_m=0.2), BASELINE)])
        heading, now, before = text.splitlines()
        self.assertEqual(now.count("!"), 1, text)
        self.assertIn("0.200!", now)
        self.assertIn("0.100 ", before)
        self.assertNotIn("!", before)
        place = heading.index("ATE [m]") + len("ATE [m]")
        self.assertEqual(now[place - 5:place], "0.200", "below its heading:\n" + text)

    def test_a_recording_that_is_not_here_is_told(self):
        text = results.text_table([("mh_01", None, BASELINE)])
        self.assertIn("not here", text)
        self.assertNotIn("!", text)

    def test_the_page_has_a_row_for_each_recording(self):
        text = results.markdown_table({"hall": BASELINE}, {"hall": "a hall", "yard": "a yard"})
        self.assertIn("| a hall | 0.100 | 0.050 | -0.20 | 3.0 | 95.0 | 10.0 | 20 |", text)
        self.assertNotIn("yard", text)


class ReadRunTest(unittest.TestCase):
    """A folder of run_bag."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="results_test_")
        self.addCleanup(shutil.rmtree, self.folder)
        self._write("events.csv", "#stamp [ns],severity,code\n1,info,loop_found,\"a\",x=1\n")
        self._write("timing.json", json.dumps(
            {"stages": {"tracker+estimator": {"count": 100, "cpu_seconds": 1.5}}}))

    def test_without_evaluation_it_never_initialised(self):
        figures = results.read_run(self.folder)
        self.assertIsNone(figures["ate_m"])
        self.assertEqual(figures["loops"], 1)
        self.assertEqual(figures["frame_ms"], 15.0)

    def test_all_figures(self):
        estimate = {"ate_m": {"rmse": 0.03}, "scale_error_percent": -0.1,
                    "first_pose_after_s": 3.0, "completeness_percent": 90.0}
        self._write("evaluation.json", json.dumps({"estimates": [
            dict(estimate, name="vio_live"),
            dict(estimate, name="loop_final", ate_m={"rmse": 0.02})]}))
        figures = results.read_run(self.folder)
        self.assertEqual((figures["ate_m"], figures["loop_ate_m"]), (0.03, 0.02))
        self.assertEqual(figures["initialised_s"], 3.0)

    def _write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(text)


if __name__ == "__main__":
    unittest.main()
