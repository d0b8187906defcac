"""Quaternion arithmetic against rotation matrices and hand-computed angles."""

import unittest

import numpy as np
from support import IDENTITY, about, matrix

from vins_evaluation import rotations


def random_quaternions(count, seed=3):
    return rotations.normalized(np.random.default_rng(seed).normal(size=(count, 4)))


class RotationsTest(unittest.TestCase):

    def test_products_are_products_of_matrices(self):
        for a, b in zip(random_quaternions(20, 1), random_quaternions(20, 2)):
            np.testing.assert_allclose(matrix(rotations.multiply(a, b)),
                                       matrix(a) @ matrix(b), atol=1e-14)

    def test_vectors_turn_as_by_the_matrix(self):
        vectors = np.random.default_rng(4).normal(size=(20, 3))
        q = random_quaternions(20)
        turned = rotations.rotate(q, vectors)
        for i in range(20):
            np.testing.assert_allclose(turned[i], matrix(q[i]) @ vectors[i], atol=1e-14)

    def test_a_matrix_gives_its_quaternion_back_even_at_half_turns(self):
        half_turns = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0.6, 0.8, 0]])
        for q in np.concatenate([random_quaternions(20), half_turns, IDENTITY[None]]):
            back = rotations.from_matrix(matrix(q))
            # q and -q are the same rotation.
            self.assertAlmostEqual(abs(float(back @ q)), 1.0, places=14)
            self.assertGreaterEqual(back[3], 0.0)

    def test_angle_does_not_mind_the_sign_of_the_quaternion(self):
        q = about([1, 2, 3], 50.0)
        self.assertAlmostEqual(np.degrees(rotations.angle(q)), 50.0)
        self.assertAlmostEqual(np.degrees(rotations.angle(-q)), 50.0)

    def test_yaw_and_tilt_of_a_turn_then_a_tilt(self):
        q = rotations.multiply(about([3, -4, 0], 10.0), about([0, 0, 1], -30.0))
        for sign in (1.0, -1.0):
            yaw, tilt = rotations.yaw_and_tilt(sign * q)
            self.assertAlmostEqual(np.degrees(yaw), -30.0)
            self.assertAlmostEqual(np.degrees(tilt), 10.0)

    def test_tilt_is_the_angle_between_the_verticals(self):
        q = random_quaternions(20)
        _, tilt = rotations.yaw_and_tilt(q)
        vertical = rotations.rotate(q, np.array([0.0, 0.0, 1.0]))
        np.testing.assert_allclose(np.cos(tilt), vertical[:, 2], atol=1e-14)

    def test_slerp_turns_evenly_along_the_shorter_arc(self):
        begin = np.tile(about([0, 0, 1], 10.0), (3, 1))
        end = np.tile(-about([0, 0, 1], 100.0), (3, 1))
        between = rotations.slerp(begin, end, np.array([0.0, 1.0 / 3.0, 1.0]))
        yaw, _ = rotations.yaw_and_tilt(between)
        np.testing.assert_allclose(np.degrees(yaw), [10.0, 40.0, 100.0], atol=1e-12)

    def test_slerp_between_equal_rotations_stays_there(self):
        q = random_quaternions(5)
        np.testing.assert_allclose(rotations.slerp(q, q, np.full(5, 0.3)), q, atol=1e-15)


if __name__ == "__main__":
    unittest.main()
