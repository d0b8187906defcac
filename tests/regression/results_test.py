#!/usr/bin/python3
"""What counts as clearly worse than the baseline, and how it is shown."""

import contextlib
import io
import json
import os
import shutil
import tempfile
import unittest
from unittest import mock

import compare_runs
from vins_regression import recordings, results

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


class BoundsTest(unittest.TestCase):
    """Absolute bounds, which a new baseline does not move."""

    BOUNDS = {"ate_m": 0.15, "loop_ate_m": 0.075, "scale_error_percent": 1.5, "initialised_s": 4.0}

    def _beyond(self, **changes):
        return [figure.key for figure in results.beyond(dict(BASELINE, **changes), self.BOUNDS)]

    def test_within_and_beyond_each_bound(self):
        self.assertEqual(self._beyond(), [])
        for key, within, outside in (("ate_m", 0.15, 0.151), ("loop_ate_m", 0.075, 0.076),
                                     ("scale_error_percent", -1.5, -1.51),
                                     ("scale_error_percent", 1.5, 1.51),
                                     ("initialised_s", 4.0, 4.1)):
            with self.subTest(key):
                self.assertEqual(self._beyond(**{key: within}), [])
                self.assertEqual(self._beyond(**{key: outside}), [key])

    def test_a_figure_that_is_lost_is_beyond(self):
        self.assertEqual(self._beyond(initialised_s=None), ["initialised_s"])

    def test_what_has_no_bound_is_not_judged(self):
        self.assertEqual(self._beyond(frame_ms=1000.0, loops=0), [])

    def test_a_slow_drift_of_the_baseline_is_noticed(self):
        slow = dict(BASELINE, ate_m=0.2)
        self.assertEqual(results.worse(slow, slow), [], "the baseline was recorded anew")
        with contextlib.redirect_stdout(io.StringIO()) as said:
            code = compare_runs.judge({"hall": slow}, {"hall": slow}, {"hall": self.BOUNDS})
        self.assertEqual(code, 1)
        self.assertIn("hall, ATE [m]: 0.2, at most 0.15", said.getvalue())

    def test_within_bounds_and_baseline_all_is_well(self):
        with contextlib.redirect_stdout(io.StringIO()):
            code = compare_runs.judge({"hall": BASELINE, "yard": None}, {"hall": BASELINE},
                                      {"hall": self.BOUNDS})
        self.assertEqual(code, 0)

    def test_recording_anew_leaves_the_bounds(self):
        folder = tempfile.mkdtemp(prefix="results_test_")
        self.addCleanup(shutil.rmtree, folder)
        with open(compare_runs.BOUNDS, "rb") as file:
            before = file.read()
        bounds = results.load_bounds(compare_runs.BOUNDS, [r.name for r in recordings.ALL])
        page = os.path.join(folder, "results.md")
        with mock.patch.object(compare_runs, "BASELINE", os.path.join(folder, "baseline.json")), \
                mock.patch.object(compare_runs, "PAGE", page), \
                contextlib.redirect_stdout(io.StringIO()):
            compare_runs.record({"hall": dict(BASELINE, ate_m=9.0)}, bounds)
        with open(compare_runs.BOUNDS, "rb") as file:
            self.assertEqual(file.read(), before)
        with open(page, encoding="utf-8") as file:
            self.assertIn(results.bounds_table(bounds, {r.name: r.description
                                                        for r in recordings.ALL}), file.read())

    def test_the_baseline_in_use_is_within_the_bounds_in_use(self):
        bounds = results.load_bounds(compare_runs.BOUNDS, [r.name for r in recordings.ALL])
        for name, figures in compare_runs.load_baseline().items():
            self.assertEqual(results.beyond(figures, bounds[name]), [], name)

    def test_a_file_of_bounds_that_is_wrong_is_refused(self):
        folder = tempfile.mkdtemp(prefix="results_test_")
        self.addCleanup(shutil.rmtree, folder)
        path = os.path.join(folder, "bounds.json")
        for content, said in (({}, "hall: ate_m is None"),
                              ({"hall": dict(self.BOUNDS, ate_m=-1.0)}, "hall: ate_m is -1.0"),
                              ({"hall": dict(self.BOUNDS, ate=1.0)}, "unknown figure ate;"),
                              ({"hal": self.BOUNDS, "hall": self.BOUNDS}, "unknown recording hal;")):
            with self.subTest(said):
                with open(path, "w", encoding="utf-8") as file:
                    json.dump(content, file)
                with self.assertRaisesRegex(ValueError, said):
                    results.load_bounds(path, ["hall"])


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


class BoundsTableTest(unittest.TestCase):
    """What docs/results.md shows of the bounds."""

    def test_a_row_for_each_recording(self):
        text = results.bounds_table({"hall": BoundsTest.BOUNDS}, {"hall": "a hall"})
        self.assertIn("| a hall | 0.150 | 0.075 | 1.50 | 4.0 |", text)


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
