"""Alignments that must be found exactly, must be optimal, or must be refused."""

import unittest

import numpy as np
from support import IDENTITY, about, matrix, moved, trajectory, wandering

from vins_evaluation import rotations
from vins_evaluation.alignment import KINDS, Alignment, align, laid_onto_first, relative_scale
from vins_evaluation.errors import EvaluationError

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
UPRIGHT = about([0, 0, 1], 130.0)
TILTED = rotations.multiply(about([1, 2, 0], 25.0), UPRIGHT)
AWAY = np.array([10.0, -20.0, 3.0])


def rmse(truth, estimate):
    return np.sqrt(np.mean(np.sum((truth - estimate)**2, axis=1)))


class KnownTransformTest(unittest.TestCase):
    """The estimate is the truth moved by an inverse; aligning must undo that."""

    def assert_undone(self, kind, q, scale):
        truth = wandering()
        estimate = moved(truth, rotations.conjugate(q), AWAY, 1.0 / scale)
        found = align(kind, truth.positions, estimate.positions)
        self.assertAlmostEqual(found.scale, scale, places=12)
        np.testing.assert_allclose(found.rotation, matrix(q), atol=1e-12)
        back = found.apply(estimate)
        np.testing.assert_allclose(back.positions, truth.positions, atol=1e-12)
        cosine = np.sum(back.quaternions * truth.quaternions, axis=1)
        np.testing.assert_allclose(np.abs(cosine), 1.0, atol=1e-12)

    def test_posyaw_finds_yaw_and_translation(self):
        self.assert_undone("posyaw", UPRIGHT, 1.0)

    def test_se3_finds_any_rotation(self):
        self.assert_undone("se3", TILTED, 1.0)

    def test_sim3_finds_the_scale_too(self):
        self.assert_undone("sim3", TILTED, 1.25)

    def test_none_moves_nothing(self):
        poses = wandering()
        found = align("none", poses.positions + 1.0, poses.positions)
        np.testing.assert_array_equal(found.apply(poses).positions, poses.positions)
        np.testing.assert_allclose(found.quaternion, IDENTITY)

    def test_unit_square_turned_by_90_degrees_and_doubled(self):
        # (x, y) -> (5 - 2 y, 7 + 2 x) by hand; undone by halving and -90 degrees.
        estimate = np.array([[5, 7, 0], [5, 9, 0], [3, 9, 0], [3, 7, 0]], dtype=float)
        found = align("sim3", SQUARE, estimate)
        self.assertAlmostEqual(found.scale, 0.5, places=14)
        np.testing.assert_allclose(found.rotation, [[0, 1, 0], [-1, 0, 0], [0, 0, 1]],
                                   atol=1e-14)
        np.testing.assert_allclose(found.translation, [-3.5, 2.5, 0], atol=1e-14)

    def test_a_mirrored_estimate_is_not_mirrored_back(self):
        truth = wandering().positions
        found = align("sim3", truth, truth * [1.0, 1.0, -1.0])
        self.assertAlmostEqual(np.linalg.det(found.rotation), 1.0, places=12)


class PosyawTest(unittest.TestCase):

    def test_roll_and_pitch_of_the_poses_do_not_matter(self):
        truth = wandering()
        found = align("posyaw", truth.positions, moved(truth, UPRIGHT, AWAY).positions)
        leaning = moved(truth, UPRIGHT, AWAY)
        leaning.quaternions = rotations.multiply(leaning.quaternions, about([1, 1, 0], 70.0))
        again = align("posyaw", truth.positions, leaning.positions)
        np.testing.assert_array_equal(again.rotation, found.rotation)

    def test_the_vertical_stays_vertical_for_a_tilted_estimate(self):
        truth = wandering()
        found = align("posyaw", truth.positions, moved(truth, TILTED, AWAY).positions)
        np.testing.assert_allclose(found.rotation[2], [0, 0, 1], atol=1e-15)
        np.testing.assert_allclose(found.rotation[:, 2], [0, 0, 1], atol=1e-15)
        self.assertEqual(found.scale, 1.0)


class OptimalityTest(unittest.TestCase):
    """No neighbour within the same class of transforms does better."""

    STEP = 1e-3

    def neighbours(self, found):
        axes = np.eye(3)
        turning = [axes[2]] if found.kind == "posyaw" else list(axes)
        for sign in (self.STEP, -self.STEP):
            for axis in turning:
                turn = matrix(about(axis, np.degrees(sign)))
                yield Alignment(found.kind, found.scale, turn @ found.rotation,
                                found.translation)
            for axis in axes:
                yield Alignment(found.kind, found.scale, found.rotation,
                                found.translation + sign * axis)
            if found.kind == "sim3":
                yield Alignment(found.kind, found.scale * (1.0 + sign), found.rotation,
                                found.translation)

    def test_every_neighbour_fits_worse(self):
        truth = wandering()
        noise = 0.2 * np.random.default_rng(7).normal(size=truth.positions.shape)
        estimate = moved(truth, TILTED, AWAY, 1.1)
        estimate.positions = estimate.positions + noise
        for kind in ("posyaw", "se3", "sim3"):
            found = align(kind, truth.positions, estimate.positions)
            best = rmse(truth.positions, found.apply(estimate).positions)
            for other in self.neighbours(found):
                worse = rmse(truth.positions, other.apply(estimate).positions)
                self.assertGreater(worse, best, kind)

    def test_more_freedom_never_fits_worse(self):
        truth = wandering()
        estimate = moved(truth, TILTED, AWAY, 1.1)
        errors = [rmse(truth.positions,
                       align(kind, truth.positions, estimate.positions)
                       .apply(estimate).positions) for kind in KINDS]
        self.assertEqual(errors, sorted(errors, reverse=True))


class UndeterminedTest(unittest.TestCase):

    LINE = np.outer(np.arange(10.0), [1.0, 2.0, 0.0])
    VERTICAL = np.outer(np.arange(10.0), [0.0, 0.0, 1.0])
    REST = np.ones((10, 3))

    def assert_refused(self, kind, positions, advice):
        with self.assertRaisesRegex(EvaluationError, "cannot align by %s.*%s" % (kind, advice)):
            align(kind, positions, positions)

    def test_a_line_leaves_the_rotation_about_itself_free(self):
        self.assert_refused("se3", self.LINE, "use --align posyaw")
        self.assert_refused("sim3", self.LINE, "use --align posyaw")
        np.testing.assert_allclose(align("posyaw", self.LINE, self.LINE).rotation, np.eye(3),
                                   atol=1e-14)

    def test_a_vertical_line_leaves_yaw_free(self):
        self.assert_refused("posyaw", self.VERTICAL, "use --align none")

    def test_rest_leaves_everything_free(self):
        for kind in ("posyaw", "se3", "sim3"):
            self.assert_refused(kind, self.REST, "one place")


class RelativeScaleTest(unittest.TestCase):

    def test_a_line_has_a_scale_although_no_rotation(self):
        line = UndeterminedTest.LINE
        self.assertAlmostEqual(relative_scale(line, 4.0 * line), 0.25, places=14)

    def test_rest_has_none(self):
        self.assertIsNone(relative_scale(SQUARE, np.ones((4, 3))))
        self.assertIsNone(relative_scale(np.ones((4, 3)), SQUARE))

    def test_unrelated_motion_has_none(self):
        forth_and_back = np.outer([0.0, 1.0, 1.0, 0.0], [1.0, 0.0, 0.0])
        twice_as_often = np.outer([0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 0.0])
        self.assertIsNone(relative_scale(forth_and_back, twice_as_often))

    def test_rotations_are_carried_along(self):
        poses = trajectory(SQUARE)
        turned = Alignment("se3", 1.0, matrix(UPRIGHT)).apply(poses)
        np.testing.assert_allclose(turned.quaternions, np.tile(UPRIGHT, (4, 1)), atol=1e-14)


class LaidOntoFirstTest(unittest.TestCase):
    def test_first_pose_coincides_and_what_follows_keeps_its_error(self):
        truth = wandering()
        turned = moved(truth, UPRIGHT, AWAY, 1.0)
        turned.positions[-1] += [0.0, 0.0, 0.5]
        laid = laid_onto_first(truth, turned)
        errors = np.linalg.norm(laid.positions - truth.positions, axis=1)
        np.testing.assert_allclose(errors[:-1], 0.0, atol=1e-9)
        self.assertAlmostEqual(errors[-1], 0.5)


if __name__ == "__main__":
    unittest.main()
