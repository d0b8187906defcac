"""Absolute errors and coverage, computed by hand."""

import unittest

import numpy as np
from support import about, moved, trajectory, wandering

from vins_evaluation import rotations
from vins_evaluation.metrics import AbsoluteErrors, Coverage, Statistics, scale_error
from vins_evaluation.trajectory import NANOSECONDS, Trajectory


def seconds(*values):
    return np.array([round(value * NANOSECONDS) for value in values], dtype=np.int64)


class StatisticsTest(unittest.TestCase):

    def test_of_four_numbers(self):
        statistics = Statistics(np.array([0.0, 6.0, 8.0, 0.0]))
        self.assertEqual(statistics.rmse, 5.0)
        self.assertEqual(statistics.mean, 3.5)
        self.assertEqual(statistics.median, 3.0)
        self.assertAlmostEqual(statistics.std, np.sqrt(25.0 - 3.5**2))
        self.assertEqual((statistics.min, statistics.max), (0.0, 8.0))

    def test_as_dict_has_every_name(self):
        found = Statistics(np.array([2.0])).as_dict()
        self.assertEqual(found, {"rmse": 2.0, "mean": 2.0, "median": 2.0, "std": 0.0,
                                 "min": 2.0, "max": 2.0})


class AbsoluteErrorsTest(unittest.TestCase):

    def test_one_displaced_pose_of_four(self):
        truth = trajectory(np.zeros((4, 3)))
        estimate = trajectory([[0, 0, 0], [0, 3, -4], [0, 0, 0], [0, 0, 0]])
        errors = AbsoluteErrors(truth, estimate)
        np.testing.assert_array_equal(errors.vectors[1], [0, 3, -4])
        np.testing.assert_array_equal(errors.position, [0, 5, 0, 0])
        self.assertEqual(Statistics(errors.position).rmse, 2.5)

    def test_a_turned_world_is_a_yaw_error_however_the_body_lies(self):
        truth = wandering()
        errors = AbsoluteErrors(truth, moved(truth, about([0, 0, 1], 12.0), np.zeros(3)))
        np.testing.assert_allclose(errors.rotation, 12.0)
        np.testing.assert_allclose(errors.yaw, 12.0)
        np.testing.assert_allclose(errors.tilt, 0.0, atol=1e-6)

    def test_a_tilted_world_is_a_tilt_error(self):
        truth = wandering()
        errors = AbsoluteErrors(truth, moved(truth, about([1, -1, 0], 7.0), np.zeros(3)))
        np.testing.assert_allclose(errors.rotation, 7.0)
        np.testing.assert_allclose(errors.tilt, 7.0)
        np.testing.assert_allclose(errors.yaw, 0.0, atol=1e-9)

    def test_both_compose_to_the_whole(self):
        truth = wandering()
        q = rotations.multiply(about([1, 0, 0], 20.0), about([0, 0, 1], -50.0))
        errors = AbsoluteErrors(truth, moved(truth, q, np.zeros(3)))
        # The half-angle formula for turns about perpendicular axes.
        whole = 2.0 * np.degrees(np.arccos(np.cos(np.radians(10)) * np.cos(np.radians(25))))
        np.testing.assert_allclose(errors.yaw, -50.0)
        np.testing.assert_allclose(errors.tilt, 20.0)
        np.testing.assert_allclose(errors.rotation, whole)

    def test_positions_alone_have_no_rotation_error(self):
        truth = wandering()
        bare = Trajectory(truth.stamps, truth.positions)
        for errors in (AbsoluteErrors(truth, bare), AbsoluteErrors(bare, truth)):
            self.assertIsNone(errors.rotation)
            self.assertIsNone(errors.yaw)
            self.assertIsNone(errors.tilt)
            np.testing.assert_array_equal(errors.position, 0.0)


class CoverageTest(unittest.TestCase):

    TRUTH = seconds(100, 104, 110)

    def test_a_hole_counts_where_it_is_wider_than_allowed(self):
        stamps = seconds(100, 101, 102, 105, 106, 107, 108, 109, 110)
        hole = Coverage(self.TRUTH, stamps, 1.0)
        self.assertEqual(hole.completeness, 70.0)
        self.assertEqual(hole.longest_gap, 3.0)
        self.assertEqual(hole.first_pose, 0.0)
        self.assertEqual(Coverage(self.TRUTH, stamps, 3.0).completeness, 100.0)

    def test_a_late_start_and_an_early_end(self):
        late = Coverage(self.TRUTH, seconds(102.5, 103, 103.5, 104, 104.5), 0.5)
        self.assertEqual(late.completeness, 20.0)
        self.assertEqual(late.first_pose, 2.5)
        self.assertEqual(late.longest_gap, 5.5)

    def test_time_without_ground_truth_does_not_count(self):
        wide = Coverage(self.TRUTH, seconds(*np.arange(90.5, 120.0)), 1.0)
        self.assertEqual(wide.completeness, 100.0)
        self.assertEqual(wide.first_pose, 0.0)
        self.assertEqual(wide.longest_gap, 1.0)

    def test_a_gap_is_measured_whole_at_the_borders_too(self):
        # From 99 to 102 is a gap of 3 s, though only 2 s of it lie inside.
        across = Coverage(self.TRUTH, seconds(99, 102, 103), 2.0)
        self.assertEqual(across.completeness, 10.0)


class ScaleErrorTest(unittest.TestCase):

    def test_sign_and_size(self):
        self.assertAlmostEqual(scale_error(1.0 / 1.02), 2.0)
        self.assertAlmostEqual(scale_error(1.0 / 0.9), -10.0)
        self.assertIsNone(scale_error(None))


if __name__ == "__main__":
    unittest.main()
