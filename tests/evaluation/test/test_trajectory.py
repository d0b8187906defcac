"""Interpolation, lengths and order of a Trajectory."""

import unittest

import numpy as np
from support import IDENTITY, about, trajectory

from vins_evaluation import rotations
from vins_evaluation.trajectory import NANOSECONDS, Trajectory

SECOND = NANOSECONDS


def two_poses():
    return Trajectory([10 * SECOND, 12 * SECOND], [[0, 0, 0], [4, 0, -2]],
                      np.stack([IDENTITY, about([0, 0, 1], 90.0)]))


class InterpolationTest(unittest.TestCase):

    def test_midway_is_the_midpoint_and_half_of_the_turn(self):
        _, poses, where = two_poses().interpolate(np.array([11 * SECOND]), 2 * SECOND)
        np.testing.assert_allclose(poses.positions, [[2, 0, -1]])
        np.testing.assert_allclose(poses.quaternions, about([0, 0, 1], [45.0]))
        np.testing.assert_allclose(where, [0.5])

    def test_nothing_is_extrapolated(self):
        stamps = np.array([10 * SECOND - 1, 10 * SECOND, 12 * SECOND, 12 * SECOND + 1])
        served, poses, where = two_poses().interpolate(stamps, 2 * SECOND)
        self.assertEqual(served.tolist(), [False, True, True, False])
        np.testing.assert_allclose(poses.positions, [[0, 0, 0], [4, 0, -2]])
        np.testing.assert_allclose(where, [0.0, 1.0])

    def test_a_gap_serves_its_ends_only(self):
        stamps = np.array([10 * SECOND, 11 * SECOND, 12 * SECOND])
        served, _, _ = two_poses().interpolate(stamps, 2 * SECOND - 1)
        self.assertEqual(served.tolist(), [True, False, True])
        served, _, _ = two_poses().interpolate(stamps, 2 * SECOND)
        self.assertTrue(np.all(served))

    def test_nanoseconds_survive_stamps_of_this_century(self):
        begin = 1403715274302142976
        poses = Trajectory([begin, begin + 4], [[0, 0, 0], [4, 0, 0]])
        _, between, _ = poses.interpolate(np.array([begin + 1, begin + 3]), 4)
        np.testing.assert_allclose(between.positions[:, 0], [1.0, 3.0])
        self.assertEqual(between.stamps.tolist(), [begin + 1, begin + 3])

    def test_positions_alone_interpolate_too(self):
        poses = Trajectory([0, 2], [[0, 0, 0], [2, 2, 2]])
        _, between, _ = poses.interpolate(np.array([1]), 2)
        np.testing.assert_allclose(between.positions, [[1, 1, 1]])
        self.assertFalse(between.has_orientation)

    def test_a_densely_sampled_circle_is_met_between_the_samples(self):
        angle = np.radians(np.arange(0.0, 91.0))
        positions = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        circle = trajectory(positions, about([0, 0, 1], np.degrees(angle)))
        midway = (circle.stamps[:-1] + circle.stamps[1:]) // 2
        _, between, _ = circle.interpolate(midway, SECOND)
        # The chord of 1 degree lies at most 1 - cos(0.5 deg) = 3.8e-5 inside.
        radius = np.linalg.norm(between.positions, axis=1)
        self.assertLess(np.max(1.0 - radius), 3.9e-5)
        yaw, tilt = rotations.yaw_and_tilt(between.quaternions)
        np.testing.assert_allclose(np.degrees(yaw), np.arange(0.5, 90.0), atol=1e-9)
        np.testing.assert_allclose(tilt, 0.0, atol=1e-12)


class TrajectoryTest(unittest.TestCase):

    def test_path_lengths_add_up_along_a_square(self):
        square = trajectory([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0]])
        np.testing.assert_allclose(square.path_lengths(), [0, 1, 2, 3, 4])

    def test_shifted_moves_the_stamps_only(self):
        later = two_poses().shifted(5)
        self.assertEqual(later.stamps.tolist(), [10 * SECOND + 5, 12 * SECOND + 5])
        np.testing.assert_array_equal(later.positions, two_poses().positions)

    def test_disorder_and_unequal_lengths_are_refused(self):
        with self.assertRaisesRegex(ValueError, "rise strictly"):
            Trajectory([2, 1], np.zeros((2, 3)))
        with self.assertRaisesRegex(ValueError, "2 stamps, 1 positions"):
            Trajectory([1, 2], np.zeros((1, 3)))
        with self.assertRaisesRegex(ValueError, "2 stamps, 1 quaternions"):
            Trajectory([1, 2], np.zeros((2, 3)), [IDENTITY])


if __name__ == "__main__":
    unittest.main()
