"""Relative pose error over distances.

The relative error of Zhang & Scaramuzza, "A tutorial on quantitative trajectory
evaluation for visual(-inertial) odometry", IROS 2018, as published in
rpg_trajectory_evaluation with alignment by the first state; the idea is from
Geiger, Lenz, Urtasun: "Are we ready for autonomous driving? The KITTI vision
benchmark suite", CVPR 2012.

A sub-trajectory of length d begins at every associated pose k. It ends at the
pose m > k whose distance along the ground truth's path is nearest to d, and is
left out where that misses d by more than a tenth or where the path ends before.
The estimate's sub-trajectory is laid onto the true one by its first pose; its last pose then
misses by

    E = (T_truth,k^-1 T_truth,m)^-1 (T_estimate,k^-1 T_estimate,m) .
"""

import numpy as np

from vins_evaluation import rotations
from vins_evaluation.metrics import Statistics

LENGTH_TOLERANCE = 0.1
# Metres by which rounding may carry a goal beyond the end of the path.
_ROUNDING = 1e-6


class RelativeErrors:
    """Errors at the ends of sub-trajectories of one length.

    Percent and degrees per metre are by the nominal length, as in the
    published implementation.

    Attributes:
        distance: the nominal length, metres.
        translation: (K,) metres; translation_percent: (K,) of the length.
        rotation: (K,) degrees; rotation_per_metre: (K,) degrees per metre.
    """

    SERIES = ("translation", "translation_percent", "rotation", "rotation_per_metre")

    def __init__(self, distance, translation, rotation):
        self.distance = distance
        self.translation = translation
        self.translation_percent = 100.0 * translation / distance
        self.rotation = rotation
        self.rotation_per_metre = rotation / distance

    def __len__(self):
        return len(self.translation)

    def statistics(self, series):
        """Statistics of one of SERIES; None without sub-trajectories."""
        values = getattr(self, series)
        return Statistics(values) if len(values) else None


def relative_errors(truth, estimate, travelled, distance):
    """RelativeErrors over one distance.

    Args:
        truth, estimate: Trajectories with the same stamps and with rotations;
            the estimate scaled, if the alignment scales (its rotation and
            translation cancel).
        travelled: (N,) metres along the ground truth's path at those stamps.
        distance: metres.
    """
    begins, ends = sub_trajectories(travelled, distance)
    true_p, true_q = _relative_poses(truth, begins, ends)
    p, q = _relative_poses(estimate, begins, ends)
    # |translation of E| = |p - true_p|: E only turns that difference.
    translation = np.linalg.norm(p - true_p, axis=1)
    rotation = rotations.angle(rotations.multiply(rotations.conjugate(true_q), q))
    return RelativeErrors(distance, translation, np.degrees(rotation))


def sub_trajectories(travelled, distance):
    """Indices of the first and the last poses of the sub-trajectories.

    Args:
        travelled: (N,) metres, not falling.
        distance: metres.
    Returns:
        begins, ends: (K,) indices, begins < ends.
    """
    goals = travelled + distance
    # Of several poses at the same place (a stop) the first is taken.
    after = np.searchsorted(travelled, goals, side="left")
    last = len(travelled) - 1
    before = np.searchsorted(travelled, travelled[after - 1], side="left")
    after = np.minimum(after, last)
    nearer = np.abs(travelled[before] - goals) <= np.abs(travelled[after] - goals)
    ends = np.where(nearer, before, after)
    misses = np.abs(travelled[ends] - goals)
    begins = np.arange(len(travelled))
    kept = (misses <= LENGTH_TOLERANCE * distance) & (ends > begins)
    # Else many would end at the last pose, each a little shorter than the other.
    kept &= goals <= travelled[-1] + _ROUNDING
    return begins[kept], ends[kept]


def _relative_poses(trajectory, begins, ends):
    """T_begin^-1 T_end: positions (K, 3) and quaternions (K, 4)."""
    inverse = rotations.conjugate(trajectory.quaternions[begins])
    step = trajectory.positions[ends] - trajectory.positions[begins]
    return (rotations.rotate(inverse, step),
            rotations.multiply(inverse, trajectory.quaternions[ends]))


def usual_distances(path_length):
    """Up to five lengths of the series 1, 2, 5, 10, 20, ... for a path.

    The longest is at most half of the path, so that the sub-trajectories of it
    are more than a few that share most of their way.

    Args:
        path_length: metres.
    Returns:
        list of metres, rising; empty for a path under 0.2 m.
    """
    series = [float("%de%d" % (mantissa, exponent))
              for exponent in range(-1, 6) for mantissa in (1, 2, 5)]
    return [length for length in series if length <= path_length / 2.0][-5:]
