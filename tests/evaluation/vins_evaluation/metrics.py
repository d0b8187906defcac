"""Errors of single poses, and how much of the time there are poses.

Definitions:
  Sturm, Engelhard, Endres, Burgard, Cremers: "A benchmark for the evaluation
  of RGB-D SLAM systems", IROS 2012 (absolute trajectory error, ATE);
  Zhang, Scaramuzza: "A tutorial on quantitative trajectory evaluation for
  visual(-inertial) odometry", IROS 2018, published as
  rpg_trajectory_evaluation (rotation part of the ATE).
"""

import numpy as np

from vins_evaluation import rotations
from vins_evaluation.trajectory import NANOSECONDS


class Statistics:
    """RMSE, mean, median, standard deviation, minimum and maximum of errors."""

    NAMES = ("rmse", "mean", "median", "std", "min", "max")

    def __init__(self, errors):
        """Args: errors: (N,), N > 0, non-negative."""
        self.rmse = float(np.sqrt(np.mean(np.square(errors))))
        self.mean = float(np.mean(errors))
        self.median = float(np.median(errors))
        self.std = float(np.std(errors))
        self.min = float(np.min(errors))
        self.max = float(np.max(errors))

    def as_dict(self):
        """{name: value} in the order of NAMES."""
        return {name: getattr(self, name) for name in self.NAMES}


class AbsoluteErrors:
    """Errors of aligned poses, instant by instant.

    With R_estimate = R_error R_truth, so that R_error turns in the world frame,
    rotation is the angle of R_error; tilt the angle between the true and the
    estimated direction of gravity; yaw the turn about the vertical that is left
    (see rotations.yaw_and_tilt).

    Attributes:
        vectors: (N, 3) metres, estimate minus truth, in the truth's frame.
        position: (N,) metres, their lengths.
        rotation, yaw, tilt: (N,) degrees, yaw with its sign (positive: the
            estimate is turned too far to the left); None where truth or
            estimate has positions only.
    """

    def __init__(self, truth, estimate):
        """Args: truth, estimate: Trajectories with the same stamps."""
        self.vectors = estimate.positions - truth.positions
        self.position = np.linalg.norm(self.vectors, axis=1)
        self.rotation = self.yaw = self.tilt = None
        if truth.has_orientation and estimate.has_orientation:
            error = rotations.multiply(estimate.quaternions,
                                       rotations.conjugate(truth.quaternions))
            yaw, tilt = rotations.yaw_and_tilt(error)
            self.rotation = np.degrees(rotations.angle(error))
            self.yaw, self.tilt = np.degrees(yaw), np.degrees(tilt)


class Coverage:
    """How much of the truth's time has an estimate.

    Attributes:
        completeness: percent of the time from the truth's first pose to its
            last, moving or not, that lies between two successive estimated
            poses at most max_gap apart.
        longest_gap: seconds of that time, at the most, without a pose: before
            the first, between two, or after the last.
        first_pose: seconds from the truth's first pose to the first estimated
            one (0 if the estimate began earlier).
    """

    def __init__(self, truth_stamps, estimate_stamps, max_gap):
        """Args: stamps: int64 nanoseconds, rising; max_gap: seconds."""
        begin, end = truth_stamps[0], truth_stamps[-1]
        clipped = np.clip(estimate_stamps, begin, end)
        steps = np.diff(estimate_stamps)
        covered = np.diff(clipped)[steps <= round(max_gap * NANOSECONDS)]
        self.completeness = 100.0 * float(np.sum(covered)) / float(end - begin)
        gaps = np.diff(np.concatenate([[begin], clipped, [end]]))
        self.longest_gap = float(np.max(gaps)) / NANOSECONDS
        self.first_pose = float(clipped[0] - begin) / NANOSECONDS


def scale_error(scale):
    """Percent by which an estimate is too large (positive) or too small.

    Args:
        scale: what the estimate is to be multiplied by (sim3), or None.
    """
    return None if scale is None else 100.0 * (1.0 / scale - 1.0)
