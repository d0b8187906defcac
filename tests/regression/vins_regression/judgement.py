"""Accuracy against ground truth, rates and covariances of what was heard."""

import numpy as np

from vins_regression import files  # noqa: F401 (makes vins_evaluation importable)
from vins_evaluation.evaluation import Settings, evaluate
from vins_evaluation.sources import LoadedTrajectory, load
from vins_evaluation.trajectory import Trajectory


def evaluated(ground_truth, poses, **settings):
    """EstimateResult of poses against a file (or ASL folder) of ground truth.

    Args:
        poses: list of StampedPose.
        settings: of vins_evaluation's Settings.
    """
    trajectory = Trajectory([pose.stamp for pose in poses], [pose.position for pose in poses],
                            [pose.quaternion for pose in poses])
    estimate = LoadedTrajectory("heard", trajectory, [])
    return evaluate(load(ground_truth), [estimate], Settings(**settings), ["heard"]).results[0]


def position_error(ground_truth, poses, **settings):
    """The ATE, metres."""
    return evaluated(ground_truth, poses, **settings).statistics("position").rmse


def distances(poses, others):
    """(stamp, metres between the positions) where two lists of StampedPose have the same stamp."""
    positions = {pose.stamp: np.array(pose.position) for pose in others}
    return [(pose.stamp, np.linalg.norm(pose.position - positions[pose.stamp]))
            for pose in poses if pose.stamp in positions]


def rate(stamps):
    """Messages a second, by the middle one of the distances in time.

    Args:
        stamps: nanoseconds.
    """
    return 1e9 / np.median(np.diff(np.asarray(stamps, dtype=np.int64)))


def missing(stamps, period):
    """How many messages are not there, between the first and the last.

    Args:
        stamps: nanoseconds, rising.
        period: of the messages, nanoseconds.
    """
    steps = np.rint(np.diff(np.asarray(stamps, dtype=np.int64)) / period)
    return int(np.sum(steps - 1))


def is_covariance(matrix):
    """Whether a matrix is symmetric and positive definite.

    Symmetric to a millionth of its entries' size: it came as doubles.
    """
    asymmetry = np.abs(matrix - matrix.T).max()
    return asymmetry <= 1e-6 * np.abs(matrix).max() and np.linalg.eigvalsh(matrix).min() > 0.0


def seconds(stamp, bag_start):
    """Seconds from a bag's start to a stamp, both in nanoseconds."""
    return 1e-9 * (stamp - bag_start)


def time_of(pose, bag_start):
    """Seconds from a bag's start (nanoseconds) to a pose."""
    return seconds(pose.stamp, bag_start)
