"""The transform that carries an estimate into the frame of the ground truth.

Least squares over positions, in closed form: truth_i ~ scale R estimate_i + t.

  none    nothing is moved
  posyaw  yaw and translation: what a visual-inertial system cannot observe
          (Zhang & Scaramuzza, "A tutorial on quantitative trajectory evaluation
          for visual(-inertial) odometry", IROS 2018)
  se3     rotation and translation
  sim3    rotation, translation and scale (both: Umeyama, "Least-squares
          estimation of transformation parameters between two point patterns",
          PAMI 1991)
"""

import numpy as np

from vins_evaluation import rotations
from vins_evaluation.errors import EvaluationError
from vins_evaluation.trajectory import Trajectory

KINDS = ("none", "posyaw", "se3", "sim3")

# Of the squared spread: a track 3e-5 times as wide as long counts as a line.
_DEGENERATE = 1e-9
# Positions that stay within this many metres (RMS) are one place.
_AT_REST = 1e-6


class Alignment:
    """p_truth = scale R p_estimate + t.

    Attributes:
        kind: one of KINDS.
        scale: factor on the estimate's lengths.
        rotation: (3, 3), from the estimate's world to the truth's.
        translation: (3,) metres.
    """

    def __init__(self, kind, scale=1.0, rotation=None, translation=None):
        self.kind = kind
        self.scale = scale
        self.rotation = np.eye(3) if rotation is None else rotation
        self.translation = np.zeros(3) if translation is None else translation

    @property
    def quaternion(self):
        """The rotation as x y z w."""
        return rotations.from_matrix(self.rotation)

    def apply(self, estimate):
        """The Trajectory estimate as seen in the truth's frame."""
        positions = self.scale * estimate.positions @ self.rotation.T + self.translation
        quaternions = None
        if estimate.has_orientation:
            quaternions = rotations.multiply(self.quaternion, estimate.quaternions)
        return Trajectory(estimate.stamps, positions, quaternions)


def align(kind, truth, estimate):
    """The best Alignment of a kind between positions of the same instants.

    Args:
        kind: one of KINDS.
        truth, estimate: (N, 3) metres.
    Raises:
        EvaluationError where the positions do not determine the transform.
    """
    if kind == "none":
        return Alignment(kind)
    if kind == "posyaw":
        return _posyaw(truth, estimate)
    return _umeyama(kind, truth, estimate)


def relative_scale(truth, estimate):
    """Umeyama's scale of the estimate (truth ~ scale R estimate + t).

    Returns:
        None where there is none: either does not leave its place, or they
        move as if they had nothing to do with each other.
    """
    if min(_spread(truth), _spread(estimate)) < _AT_REST:
        return None
    _, scale, _ = _rotation_and_scale(truth, estimate)
    return scale if scale * _spread(estimate) > _DEGENERATE * _spread(truth) else None


def _spread(positions):
    """RMS distance from the centroid, metres."""
    return np.sqrt(np.mean(np.sum((positions - positions.mean(axis=0))**2, axis=1)))


def _covariance(truth, estimate):
    """Umeyama's Sigma_xy (3, 3), with truth as y and estimate as x."""
    centred_truth = truth - truth.mean(axis=0)
    centred_estimate = estimate - estimate.mean(axis=0)
    return centred_truth.T @ centred_estimate / len(truth)


def _require_determined(kind, truth, estimate, lengths_squared):
    """Refuse positions that leave a rotation free.

    Args:
        lengths_squared: how strongly the weakest of the rotation's degrees of
            freedom is held by the positions, square metres.
    """
    size = _spread(truth) * _spread(estimate)
    if size < _AT_REST**2 or lengths_squared < _DEGENERATE * size:
        shape = {"posyaw": "one place or a vertical line"}.get(kind, "one place or a line")
        raise EvaluationError(
            "cannot align by %s: the %d associated positions lie in %s, which leaves "
            "a rotation free; use --align %s"
            % (kind, len(truth), shape, "none" if kind == "posyaw" else "posyaw"))


def _posyaw(truth, estimate):
    """Maximise sum truth_i . R_z(yaw) estimate_i over yaw, both centred.

    The sum is a cos(yaw) + b sin(yaw) + constant, largest at atan2(b, a).
    """
    sigma = _covariance(truth, estimate)
    a = sigma[0, 0] + sigma[1, 1]
    b = sigma[1, 0] - sigma[0, 1]
    _require_determined("posyaw", truth, estimate, np.hypot(a, b))
    cosine, sine = np.array([a, b]) / np.hypot(a, b)
    rotation = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    translation = truth.mean(axis=0) - rotation @ estimate.mean(axis=0)
    return Alignment("posyaw", 1.0, rotation, translation)


def _rotation_and_scale(truth, estimate):
    """Umeyama 1991, equations 40, 42 and 43.

    Returns:
        rotation (3, 3), scale, singular values (3,) of Sigma_xy, falling.
    """
    u, d, vt = np.linalg.svd(_covariance(truth, estimate))
    mirror = np.array([1.0, 1.0, np.sign(np.linalg.det(u) * np.linalg.det(vt))])
    rotation = (u * mirror) @ vt
    return rotation, float(np.sum(d * mirror)) / _spread(estimate)**2, d


def _umeyama(kind, truth, estimate):
    # Division by the spread, so the places that have none go first.
    _require_determined(kind, truth, estimate, np.inf)
    rotation, scale, singular_values = _rotation_and_scale(truth, estimate)
    _require_determined(kind, truth, estimate, singular_values[1])
    scale = scale if kind == "sim3" else 1.0
    translation = truth.mean(axis=0) - scale * rotation @ estimate.mean(axis=0)
    return Alignment(kind, scale, rotation, translation)


def laid_onto_first(truth, estimate):
    """The estimate, moved so that its first pose has the truth's position and yaw.

    From there on the error grows as the covariance says; the best fit over the whole path would
    hide that.
    """
    turn = rotations.multiply(truth.quaternions[0], rotations.conjugate(estimate.quaternions[0]))
    yaw, _ = rotations.yaw_and_tilt(turn)
    c, s = np.cos(yaw), np.sin(yaw)
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return Alignment("posyaw", 1.0, R, truth.positions[0] - R @ estimate.positions[0]).apply(estimate)
