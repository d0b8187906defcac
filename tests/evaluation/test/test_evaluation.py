"""Whole evaluations with known outcome."""

import unittest

import numpy as np
from support import about, loaded, moved, shared_data, trajectory, wandering

from vins_evaluation import rotations
from vins_evaluation.errors import EvaluationError
from vins_evaluation.evaluation import Settings, evaluate
from vins_evaluation.sources import load
from vins_evaluation.trajectory import NANOSECONDS, Trajectory


def evaluate_one(truth, estimate, **settings):
    names = ["estimate"]
    return evaluate(loaded(truth, "truth.txt"), [loaded(estimate, "estimate.txt")],
                    Settings(**settings), names).results[0]


def dense_and_sparse():
    """A path sampled every 0.1 s, and every seventh pose of it."""
    dense = wandering(211)
    return dense, dense.selected(np.arange(0, 211, 7))


class KnownOutcomeTest(unittest.TestCase):

    def test_a_moved_estimate_is_perfect_once_aligned(self):
        truth, sparse = dense_and_sparse()
        estimate = moved(sparse, about([0, 0, 1], 100.0), np.array([4.0, 5.0, 6.0]))
        result = evaluate_one(truth, estimate)
        self.assertEqual(len(result.estimate), 31)
        self.assertLess(result.statistics("position").max, 1e-12)
        # Angles near zero are the root of a double's rounding.
        self.assertLess(result.statistics("rotation").max, 1e-5)
        self.assertAlmostEqual(result.scale_error, 0.0, places=10)
        self.assertEqual(result.coverage.completeness, 100.0)

    def test_the_scale_error_shows_whatever_the_alignment(self):
        truth, sparse = dense_and_sparse()
        estimate = moved(sparse, about([0, 0, 1], 100.0), np.zeros(3), 1.02)
        for align in ("none", "posyaw", "se3", "sim3"):
            result = evaluate_one(truth, estimate, align=align)
            self.assertAlmostEqual(result.scale_error, 2.0, places=10)
        self.assertLess(result.statistics("position").max, 1e-12)

    def test_without_alignment_an_offset_is_the_error(self):
        truth, sparse = dense_and_sparse()
        estimate = moved(sparse, about([0, 0, 1], 0.0), np.array([0.3, 0.0, -0.4]))
        result = evaluate_one(truth, estimate, align="none")
        self.assertAlmostEqual(result.statistics("position").rmse, 0.5, places=12)

    def test_scale_cancels_in_the_relative_error_under_sim3_only(self):
        truth, sparse = dense_and_sparse()
        estimate = moved(sparse, about([0, 0, 1], 100.0), np.zeros(3), 1.1)
        settings = {"distances": [5.0], "max_truth_gap": 0.2}
        scaled = evaluate_one(truth, estimate, align="sim3", **settings).relative[0]
        kept = evaluate_one(truth, estimate, align="posyaw", **settings).relative[0]
        self.assertGreater(len(scaled), 3)
        self.assertLess(scaled.statistics("translation").max, 1e-12)
        self.assertGreater(kept.statistics("translation").min, 0.01)

    def test_the_truth_is_met_between_its_poses(self):
        truth = trajectory(np.outer(np.arange(20.0), [1.0, 1.0, 0.0]))
        halves = np.outer(np.arange(19) + 0.5, [1.0, 1.0, 0.0])
        result = evaluate_one(truth, trajectory(halves, begin=1000.05), align="none")
        self.assertEqual(len(result.estimate), 19)
        self.assertLess(result.statistics("position").max, 1e-12)

    def test_distance_travelled_is_that_of_the_whole_truth(self):
        # Two estimated poses a lap: from one to the next it is half a lap along the
        # truth's path, but no way at all in a straight line.
        angle = np.radians(np.arange(0.0, 1801.0, 5.0))
        circle = np.stack([np.cos(angle), np.sin(angle), 0.1 * angle], axis=1)
        truth = trajectory(circle, about([0, 0, 1], np.degrees(angle)))
        estimate = truth.selected(np.arange(0, 361, 36))
        result = evaluate_one(truth, estimate, align="none", distances=[3.155],
                              max_gap=10.0)
        self.assertEqual(len(result.relative[0]), 10)

    def test_positions_alone_give_no_relative_error(self):
        truth, sparse = dense_and_sparse()
        result = evaluate_one(truth, Trajectory(sparse.stamps, sparse.positions))
        self.assertEqual(result.relative, [])
        self.assertIsNone(result.statistics("tilt"))
        self.assertLess(result.statistics("position").max, 1e-12)


class TimeTest(unittest.TestCase):

    def test_an_offset_between_the_clocks(self):
        truth, sparse = dense_and_sparse()
        late = sparse.shifted(2 * NANOSECONDS)
        off = evaluate_one(truth, late, align="none").statistics("position").rmse
        self.assertGreater(off, 0.1)
        result = evaluate_one(truth, late, align="none", time_offset=-2.0)
        self.assertLess(result.statistics("position").max, 1e-12)

    def test_start_and_duration_choose_the_evaluated_time(self):
        truth, sparse = dense_and_sparse()
        result = evaluate_one(truth, sparse, start=5.0, duration=10.0)
        self.assertAlmostEqual(result.times[0], 0.6)
        self.assertAlmostEqual(result.times[-1], 9.7)
        # The poses at 4.9 s and 15.4 s, outside, show that it does not begin or end there.
        self.assertEqual(result.coverage.first_pose, 0.0)
        self.assertAlmostEqual(result.coverage.completeness, 100.0)
        narrow = evaluate_one(truth, sparse, start=5.0, duration=10.0, max_gap=0.5)
        self.assertEqual(narrow.coverage.completeness, 0.0)

    def test_poses_in_a_hole_of_the_truth_are_not_compared(self):
        dense, sparse = dense_and_sparse()
        keep = np.ones(211, dtype=bool)
        keep[50:80] = False
        result = evaluate_one(dense.selected(keep), sparse)
        self.assertEqual(len(result.estimate), 31 - 4)
        self.assertEqual(result.coverage.completeness, 100.0)


class RefusedTest(unittest.TestCase):

    def assert_refused(self, pattern, truth, estimate, **settings):
        with self.assertRaisesRegex(EvaluationError, pattern):
            evaluate_one(truth, estimate, **settings)

    def test_no_common_time(self):
        truth, sparse = dense_and_sparse()
        self.assert_refused("estimate.txt: 0 of its 31 poses .* it covers 1100.000 to 1121.000 s"
                            ", the evaluated ground truth 1000.000 to 1021.000 s",
                            truth, sparse.shifted(100 * NANOSECONDS))

    def test_a_truth_too_sparse_to_interpolate(self):
        dense, sparse = dense_and_sparse()
        self.assert_refused(r"0.700 s apart \(median\).*at most 0.1 s \(--max-truth-gap\)",
                            sparse, dense.selected(np.arange(1, 211, 7)))

    def test_a_truth_of_one_pose(self):
        truth, sparse = dense_and_sparse()
        self.assert_refused("truth.txt: ground truth has 1 pose", truth.selected([0]), sparse)
        self.assert_refused("truth.txt: ground truth has 0 pose.*it lasts 21.000 s",
                            truth, sparse, start=30.0)

    def test_alignment_that_is_not_determined_names_the_estimate(self):
        rest = trajectory(np.zeros((10, 3)))
        self.assert_refused("estimate.txt: cannot align by posyaw", rest, rest)


class SharedDataTest(unittest.TestCase):

    def test_ground_truth_against_itself_is_perfect(self):
        truth = load(shared_data("groundtruth", "V2_01_easy.txt"))
        evaluation = evaluate(truth, [truth], Settings(), ["itself"])
        result = evaluation.results[0]
        # The published length of V2_01 is 36.5 m.
        self.assertAlmostEqual(evaluation.path_length, 36.5, places=1)
        self.assertLess(result.statistics("position").max, 1e-9)
        self.assertLess(result.statistics("rotation").max, 1e-5)
        self.assertEqual(result.coverage.completeness, 100.0)
        for errors in result.relative:
            self.assertGreater(len(errors), 1000)
            self.assertLess(errors.statistics("translation").max, 1e-9)

    def test_two_published_truths_of_one_recording_move_alike(self):
        recording = load(shared_data("euroc_v101_micro"))
        tum = load(shared_data("groundtruth", "V1_01_easy.txt"))
        result = evaluate(recording, [tum], Settings(align="none"), ["tum"]).results[0]
        self.assertGreater(len(result.estimate), 50)
        # The recording's own is known to be off in V1_01's rotation by a constant; read in
        # the wrong order of columns or of time it would not stay one.
        rotation = result.statistics("rotation")
        self.assertLess(rotation.max - rotation.min, 0.3)
        self.assertLess(result.statistics("position").max, 0.05)

    def test_drift_in_yaw_is_measured_as_it_was_made(self):
        truth = load(shared_data("groundtruth", "V1_03_difficult.txt"))
        every_tenth = truth.trajectory.selected(np.arange(0, len(truth.trajectory), 10))
        drift = np.linspace(0.0, 4.0, len(every_tenth))
        turned = rotations.multiply(about([0, 0, 1], drift), every_tenth.quaternions)
        estimate = Trajectory(every_tenth.stamps, every_tenth.positions, turned)
        result = evaluate(truth, [loaded(estimate)], Settings(align="none"), ["x"]).results[0]
        self.assertAlmostEqual(result.statistics("yaw").mean, 2.0, places=5)
        self.assertAlmostEqual(result.statistics("yaw").max, 4.0, places=5)
        self.assertLess(result.statistics("tilt").max, 1e-5)
        self.assertLess(result.statistics("position").max, 1e-12)


if __name__ == "__main__":
    unittest.main()
