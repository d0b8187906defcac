"""Relative errors against closed forms and against the definition spelt out."""

import unittest

import numpy as np
from support import about, matrix, moved, trajectory, wandering

from vins_evaluation import rotations
from vins_evaluation.relative_error import (
    LENGTH_TOLERANCE, relative_errors, sub_trajectories, usual_distances)

STEP = 0.25


def straight(count=81):
    """Along x, a pose every STEP metres."""
    return trajectory(np.outer(STEP * np.arange(count), [1.0, 0.0, 0.0]))


def errors_of(truth, estimate, distance):
    return relative_errors(truth, estimate, truth.path_lengths(), distance)


class ClosedFormTest(unittest.TestCase):

    def test_nothing_for_an_estimate_that_only_lives_in_another_frame(self):
        truth = wandering()
        q = rotations.multiply(about([1, 2, 3], 70.0), about([0, 0, 1], 40.0))
        errors = errors_of(truth, moved(truth, q, np.array([5.0, 6.0, 7.0])), 2.0)
        self.assertGreater(len(errors), 100)
        np.testing.assert_allclose(errors.translation, 0.0, atol=1e-12)
        # An angle of 1e-7 rad is the root of a double's rounding.
        np.testing.assert_allclose(errors.rotation, 0.0, atol=1e-5)

    def test_scale_error(self):
        truth = straight()
        estimate = trajectory(1.03 * truth.positions)
        errors = errors_of(truth, estimate, 5.0)
        self.assertEqual(len(errors), 81 - 20)
        np.testing.assert_allclose(errors.translation, 0.15)
        np.testing.assert_allclose(errors.translation_percent, 3.0)
        np.testing.assert_array_equal(errors.rotation, 0.0)

    def test_yaw_that_drifts_evenly_bends_a_line_to_a_circle(self):
        rate = 0.02  # rad per metre
        s = STEP * np.arange(81)
        circle = np.stack([np.sin(rate * s), 1.0 - np.cos(rate * s), 0.0 * s], axis=1) / rate
        estimate = trajectory(circle, about([0, 0, 1], np.degrees(rate * s)))
        for d in (1.0, 10.0):
            errors = errors_of(straight(), estimate, d)
            miss = np.hypot(d - np.sin(rate * d) / rate, (1.0 - np.cos(rate * d)) / rate)
            np.testing.assert_allclose(errors.translation, miss)
            np.testing.assert_allclose(errors.rotation, np.degrees(rate * d))
            np.testing.assert_allclose(errors.rotation_per_metre, np.degrees(rate))
            self.assertAlmostEqual(errors.statistics("rotation").rmse, np.degrees(rate * d))

    def test_one_jump_is_felt_by_the_sub_trajectories_across_it_only(self):
        truth = straight(41)
        jump = np.where(np.arange(41) >= 20, 0.5, 0.0)
        estimate = trajectory(truth.positions + np.outer(jump, [0.0, 0.0, 1.0]))
        errors = errors_of(truth, estimate, 1.0)
        across = np.flatnonzero(errors.translation > 0.25)
        self.assertEqual(across.tolist(), [16, 17, 18, 19])
        np.testing.assert_allclose(errors.translation[across], 0.5)


class DefinitionTest(unittest.TestCase):
    """The definition of the published implementation, with 4x4 matrices."""

    def test_against_matrices_one_by_one(self):
        truth = wandering(120)
        rng = np.random.default_rng(11)
        wobble = about([2, 1, 0], rng.normal(scale=3.0, size=120))
        estimate = trajectory(truth.positions + 0.1 * rng.normal(size=(120, 3)),
                              rotations.multiply(truth.quaternions, wobble))
        found = errors_of(truth, estimate, 1.5)
        expected = list(self.expected(truth, estimate, 1.5))
        self.assertGreater(len(expected), 50)
        np.testing.assert_allclose(found.translation, [e[0] for e in expected], atol=1e-12)
        np.testing.assert_allclose(found.rotation, [e[1] for e in expected], atol=1e-5)

    def expected(self, truth, estimate, distance):
        travelled = truth.path_lengths()
        for k, begun in enumerate(travelled):
            misses = np.abs(travelled[k:] - begun - distance)
            m = k + int(np.argmin(misses))
            long_enough = begun + distance <= travelled[-1]
            if long_enough and misses[m - k] <= LENGTH_TOLERANCE * distance:
                true_step = self.step(truth, k, m)
                error = np.linalg.inv(true_step) @ self.step(estimate, k, m)
                cosine = (np.trace(error[:3, :3]) - 1.0) / 2.0
                yield np.linalg.norm(error[:3, 3]), np.degrees(np.arccos(min(cosine, 1.0)))

    def step(self, poses, k, m):
        return np.linalg.inv(self.pose(poses, k)) @ self.pose(poses, m)

    @staticmethod
    def pose(poses, index):
        T = np.eye(4)
        T[:3, :3] = matrix(poses.quaternions[index])
        T[:3, 3] = poses.positions[index]
        return T


class SubTrajectoriesTest(unittest.TestCase):

    def pairs(self, travelled, distance):
        begins, ends = sub_trajectories(np.array(travelled, dtype=float), distance)
        return list(zip(begins.tolist(), ends.tolist()))

    def test_ends_are_the_nearest(self):
        self.assertEqual(self.pairs([0, 0.93, 1.05, 2, 2.5], 1.0), [(0, 2), (1, 3), (2, 3)])

    def test_ends_too_far_off_are_left_out(self):
        self.assertEqual(self.pairs([0, 0.85, 1.72], 1.0), [])

    def test_the_path_must_be_long_enough(self):
        self.assertEqual(self.pairs([0, 0.5, 0.95], 1.0), [])
        self.assertEqual(self.pairs([0, 0.5, 1.0], 1.0), [(0, 2)])

    def test_a_stop_ends_sub_trajectories_at_its_first_pose(self):
        self.assertEqual(self.pairs([0, 1, 1, 1, 2], 1.0),
                         [(0, 1), (1, 4), (2, 4), (3, 4)])
        self.assertEqual(self.pairs([0, 0.96, 0.96, 1.1], 1.0), [(0, 1)])

    def test_rest_has_none(self):
        self.assertEqual(self.pairs([0, 0, 0], 1.0), [])


class UsualDistancesTest(unittest.TestCase):

    def test_follow_the_length_of_the_path(self):
        self.assertEqual(usual_distances(79.0), [1, 2, 5, 10, 20])
        self.assertEqual(usual_distances(100.0), [2, 5, 10, 20, 50])
        self.assertEqual(usual_distances(0.5), [0.1, 0.2])
        self.assertEqual(usual_distances(0.1), [])


if __name__ == "__main__":
    unittest.main()
