"""Figures, text table, JSON and the HTML page of a known evaluation."""

import html.parser
import json
import re
import unittest

import numpy as np
from support import about, loaded, moved, trajectory, wandering

from vins_evaluation import figures, plots
from vins_evaluation.evaluation import Settings, evaluate
from vins_evaluation.html_report import html_report
from vins_evaluation.json_report import json_report
from vins_evaluation.text_table import text_table
from vins_evaluation.trajectory import Trajectory

AS_IT_IS = about([0, 0, 1], 0.0)
VOID_TAGS = {"meta", "link", "br", "img"}


def evaluation(estimates, names, **settings):
    truth = wandering(400)
    return evaluate(loaded(truth, "truth.txt"), [loaded(estimate) for estimate in estimates],
                    Settings(**settings), names)


def two_estimates(names=("near", "far"), **settings):
    """Off by 0.1 m and by 0.2 m without alignment; the second with a hole."""
    truth = wandering(400)
    near = moved(truth, AS_IT_IS, np.array([0.1, 0.0, 0.0]))
    far = moved(truth, AS_IT_IS, np.array([0.0, 0.2, 0.0]))
    keep = np.ones(400, dtype=bool)
    keep[100:150] = False
    return evaluation([near, far.selected(keep)], names, align="none", **settings)


class FigureTest(unittest.TestCase):

    def figure(self, values, rank=abs):
        return figures.Figure("label", "m", 2, values, rank)

    def test_the_best_ranks_lowest(self):
        self.assertEqual(self.figure([3.0, -1.0, 2.0]).best, 1)
        self.assertEqual(self.figure([3.0, 9.0, 2.0], lambda value: -value).best, 1)
        self.assertEqual(self.figure([None, 4.0, 5.0]).best, 1)

    def test_no_prize_without_a_contest(self):
        self.assertIsNone(self.figure([3.0]).best)
        self.assertIsNone(self.figure([None, 3.0]).best)
        self.assertIsNone(self.figure([1.0, 2.0], None).best)
        self.assertIsNone(self.figure([1.001, 1.002]).best)

    def test_texts(self):
        figure = self.figure([1.234, None, -0.004, -1.236])
        self.assertEqual([figure.text(i) for i in range(4)], ["1.23", "-", "0.00", "-1.24"])


class TextTableTest(unittest.TestCase):

    def test_figures_stand_in_their_columns_with_the_best_marked(self):
        text = text_table(two_estimates())
        lines = {line.split("  ")[1]: line.split() for line in text.splitlines()
                 if line.startswith("  ") and "[" in line}
        self.assertEqual(lines["completeness"], ["completeness", "[%]", "100.00*", "87.22"])
        self.assertIn("rmse              [m]    0.1000*  0.2000", text)
        self.assertIn("alignment     none", text)
        self.assertTrue(text.endswith("* best\n"))

    def test_columns_line_up(self):
        lines = text_table(two_estimates(("n", "a rather long name"))).splitlines()
        start = next(i for i, line in enumerate(lines) if line.startswith("Coverage"))
        stop = next(i for i, line in enumerate(lines) if line.startswith("Relative"))
        rows = [line for line in lines[start:stop] if line.startswith("  ")]
        # Every value ends one short of the heading, which leaves room for the mark *.
        self.assertEqual({len(row.rstrip("*")) for row in rows}, {len(lines[start - 1]) - 1})

    def test_distances_without_sub_trajectories_show_dashes(self):
        row = [line for line in text_table(two_estimates(distances=[1000.0])).splitlines()
               if line.startswith("1000")][0]
        self.assertEqual(row.split(), ["1000", "near", "0", "-", "-", "-", "-", "-"])

    def test_positions_alone_leave_rotations_out(self):
        truth = wandering(400)
        text = text_table(evaluation([Trajectory(truth.stamps, truth.positions)], ["bare"]))
        self.assertIn("Position error", text)
        for word in ("Rotation", "tilt", "RPE", "best"):
            self.assertNotIn(word, text)


class JsonReportTest(unittest.TestCase):

    def test_figures_by_name(self):
        report = json.loads(json_report(two_estimates(distances=[2.0, 1000.0])))
        near, far = report["estimates"]
        self.assertEqual(report["settings"]["align"], "none")
        self.assertEqual(report["ground_truth"]["poses"], 400)
        self.assertEqual((near["name"], far["name"]), ("near", "far"))
        self.assertAlmostEqual(near["ate_m"]["rmse"], 0.1)
        self.assertAlmostEqual(far["ate_m"]["max"], 0.2)
        self.assertEqual(far["poses_compared"], 350)
        self.assertAlmostEqual(far["longest_gap_s"], 5.1)
        self.assertAlmostEqual(far["completeness_percent"], 100.0 * (39.9 - 5.1) / 39.9)
        self.assertLess(near["rpe"][0]["translation_m"]["max"], 1e-12)
        self.assertEqual(near["rpe"][1], {
            "distance_m": 1000.0, "sub_trajectories": 0, "translation_m": None,
            "translation_percent": None, "rotation_deg": None, "rotation_deg_per_m": None})

    def test_what_is_not_known_is_null(self):
        rest = trajectory(np.zeros((10, 3)))
        report = json.loads(json_report(evaluate(
            loaded(rest), [loaded(Trajectory(rest.stamps, rest.positions))],
            Settings(align="none"), ["bare"])))
        bare = report["estimates"][0]
        self.assertIsNone(bare["rotation_deg"])
        self.assertIsNone(bare["scale_error_percent"])
        self.assertEqual(bare["rpe"], [])


class Page(html.parser.HTMLParser):
    """Collects a page's tags, ids and text; fails on tags that do not match."""

    def __init__(self, text):
        super().__init__()
        self.open_tags, self.tags, self.ids, self.attributes, self.text = [], [], [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs
        self.ids += [value for name, value in attrs if name == "id"]
        if tag not in VOID_TAGS:
            self.open_tags.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        self.open_tags.pop()

    def handle_endtag(self, tag):
        if not self.open_tags or self.open_tags.pop() != tag:
            raise AssertionError("</%s> closes another tag" % tag)

    def handle_data(self, data):
        self.text.append(data)


class HtmlReportTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.evaluation = two_estimates(("<near> & \"dear\"", "far"))
        cls.text = html_report(cls.evaluation, "evaluate_trajectory a <b>")
        cls.page = Page(cls.text)

    def test_it_is_whole_and_has_all_plots(self):
        self.assertEqual(self.page.open_tags, [])
        self.assertEqual(self.page.tags.count("svg"), 5)
        self.assertEqual(self.page.tags.count("table"), 2)
        self.assertNotIn("nan", self.text.lower().split())

    def test_it_needs_nothing_from_elsewhere(self):
        self.assertNotRegex(self.text, r"(?i)https?:|//[a-z]|@import|<script|<link|<img")
        for name, value in self.page.attributes:
            if name in ("src", "href", "xlink:href"):
                self.assertRegex(value, "^#")

    def test_references_inside_are_met_once(self):
        used = set(re.findall(r'href="#([^"]+)"|url\(#([^)]+)\)', self.text))
        used = {first or second for first, second in used}
        self.assertGreater(len(used), 5)
        self.assertEqual(sorted(self.page.ids), sorted(used))

    def test_what_the_user_typed_is_text_not_markup(self):
        shown = "".join(self.page.text)
        self.assertIn('<near> & "dear"', shown)
        self.assertIn("evaluate_trajectory a <b>", shown)
        self.assertNotIn("b", self.page.tags)

    def test_best_figures_are_marked(self):
        self.assertRegex(self.text, r'rmse</th><td class="unit">m</td>'
                                    r'<td class="best">0.1000</td><td>0.2000</td>')

    def test_the_same_input_gives_the_same_page(self):
        self.assertEqual(html_report(self.evaluation, "evaluate_trajectory a <b>"), self.text)

    def test_positions_alone_give_fewer_plots(self):
        truth = wandering(400)
        bare = evaluation([Trajectory(truth.stamps, truth.positions)], ["bare"])
        page = Page(html_report(bare, ""))
        self.assertEqual(page.tags.count("svg"), 4)
        self.assertEqual(page.tags.count("table"), 1)
        self.assertNotIn("yaw [deg]", "".join(page.text))


class DrawingTest(unittest.TestCase):
    """What is drawn of long and of broken trajectories."""

    def test_lines_stop_in_gaps_of_the_poses(self):
        points = np.arange(12.0).reshape(6, 2)
        runs = np.array([0, 0, 0, 1, 1, 1])
        drawn = plots._broken_at_gaps(points, np.array([0, 2, 4, 5]), runs)
        self.assertEqual(np.isnan(drawn[:, 0]).tolist(), [False, False, True, False, False])
        np.testing.assert_array_equal(drawn[[0, 1, 3, 4]], points[[0, 2, 4, 5]])

    def test_thinning_keeps_both_ends(self):
        for count in (1, 2, 3999, 4001, 123457):
            which = plots._thinned(count)
            self.assertEqual((which[0], which[-1]), (0, count - 1))
            self.assertLessEqual(len(which), 4001)

    def test_thinning_keeps_peaks(self):
        errors = np.zeros(50000)
        errors[31234] = -1.0
        which = plots._peaks(errors)
        self.assertIn(31234, which)
        self.assertLessEqual(len(which), 4000)

    def test_a_page_of_a_long_recording_stays_small(self):
        rng = np.random.default_rng(5)
        count = 24000  # two minutes at 200 Hz
        steps = rng.normal(size=(count, 3))
        truth = trajectory(np.cumsum(0.01 * steps, axis=0), period=0.005)
        noisy = Trajectory(truth.stamps, truth.positions + 0.01 * steps, truth.quaternions)
        whole = evaluate(loaded(truth), [loaded(noisy)] * 2, Settings(), ["a", "b"])
        self.assertLess(len(html_report(whole, "")), 1500000)


if __name__ == "__main__":
    unittest.main()
