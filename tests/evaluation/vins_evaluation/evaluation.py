"""Evaluation of several estimates against one ground truth."""

import numpy as np

from vins_evaluation import alignment, metrics, relative_error
from vins_evaluation.errors import EvaluationError
from vins_evaluation.metrics import Statistics
from vins_evaluation.trajectory import NANOSECONDS


class Settings:
    """How to evaluate.

    Attributes:
        align: one of alignment.KINDS.
        distances: lengths of sub-trajectories, metres; None: chosen by the
            length of the path.
        max_gap: seconds; the estimate counts as there between two of its poses
            that are no further apart.
        max_truth_gap: seconds; the ground truth is interpolated between two of
            its poses that are no further apart.
        start: seconds from the first pose of the ground truth to skip.
        duration: seconds to evaluate from there; None: to the end.
        time_offset: seconds to add to the stamps of the estimates.
    """

    def __init__(self, align="posyaw", distances=None, max_gap=1.0, max_truth_gap=0.1,
                 start=0.0, duration=None, time_offset=0.0):
        self.align = align
        self.distances = distances
        self.max_gap = max_gap
        self.max_truth_gap = max_truth_gap
        self.start = start
        self.duration = duration
        self.time_offset = time_offset


class EstimateResult:
    """What came out for one estimate.

    Attributes:
        name, source: for display, and as the user typed it.
        pose_count: of the estimate, within the evaluated time or not.
        alignment: the Alignment used.
        scale_error: percent (see metrics.scale_error), whatever the alignment.
        truth, estimate: Trajectories at the associated instants, the estimate
            aligned.
        times: (N,) seconds of those since the ground truth's first pose.
        absolute: AbsoluteErrors; coverage: Coverage.
        relative: list of RelativeErrors, one a distance; empty where truth or
            estimate has no rotations.
    """

    def __init__(self, name, source, pose_count):
        self.name = name
        self.source = source
        self.pose_count = pose_count

    def statistics(self, series):
        """Statistics of position, rotation, |yaw| or tilt; None where unknown."""
        errors = getattr(self.absolute, series)
        return None if errors is None else Statistics(np.abs(errors))


class Evaluation:
    """Ground truth (Trajectory, within the evaluated time), its source as typed,
    the Settings, the distances (metres) used, and a list of EstimateResult."""

    def __init__(self, truth, source, settings, results):
        self.truth = truth
        self.source = source
        self.settings = settings
        self.distances = distances_for(truth, settings)
        self.results = results

    @property
    def path_length(self):
        """Metres along the ground truth."""
        return float(self.truth.path_lengths()[-1])


def evaluate(truth, estimates, settings, names):
    """Evaluate estimates side by side.

    Args:
        truth: LoadedTrajectory of the ground truth.
        estimates: list of LoadedTrajectory.
        settings: Settings.
        names: display names of the estimates.
    Returns:
        an Evaluation.
    Raises:
        EvaluationError naming what cannot be evaluated.
    """
    window = _evaluated_time(truth, settings)
    results = []
    for estimate, name in zip(estimates, names):
        try:
            results.append(_evaluate_one(window, estimate, settings, name))
        except EvaluationError as error:
            raise EvaluationError("%s: %s" % (estimate.source, error)) from error
    return Evaluation(window, truth.source, settings, results)


def distances_for(truth, settings):
    """The lengths of sub-trajectories to evaluate, metres."""
    if settings.distances is not None:
        return sorted(set(settings.distances))
    return relative_error.usual_distances(float(truth.path_lengths()[-1]))


def _evaluated_time(truth, settings):
    """The part of the ground truth that settings.start and .duration ask for."""
    stamps = truth.trajectory.stamps
    begin = stamps[0] + round(settings.start * NANOSECONDS)
    end = stamps[-1]
    if settings.duration is not None:
        end = min(end, begin + round(settings.duration * NANOSECONDS))
    inside = (stamps >= begin) & (stamps <= end)
    if np.count_nonzero(inside) < 2:
        raise EvaluationError(
            "%s: ground truth has %d pose(s) in the evaluated time, 2 are needed (it lasts "
            "%.3f s)" % (truth.source, np.count_nonzero(inside), truth.trajectory.duration))
    return truth.trajectory.selected(inside)


def _evaluate_one(window, loaded, settings, name):
    estimate = loaded.trajectory.shifted(round(settings.time_offset * NANOSECONDS))
    result = EstimateResult(name, loaded.source, len(estimate))
    result.truth, associated, travelled = _associate(window, estimate, settings)
    true_p = result.truth.positions
    result.alignment = alignment.align(settings.align, true_p, associated.positions)
    result.scale_error = metrics.scale_error(
        alignment.relative_scale(true_p, associated.positions))
    result.estimate = result.alignment.apply(associated)
    result.times = (associated.stamps - window.stamps[0]) / NANOSECONDS
    result.absolute = metrics.AbsoluteErrors(result.truth, result.estimate)
    result.coverage = metrics.Coverage(window.stamps, estimate.stamps, settings.max_gap)
    result.relative = _relative(result, travelled, distances_for(window, settings))
    return result


def _associate(window, estimate, settings):
    """Interpolate the ground truth at the estimate's stamps.

    That way round because the truth is the denser one (200 Hz in EuRoC), so
    that interpolation adds next to no error; and no pose is compared twice.

    Returns:
        truth and estimate, Trajectories with the same stamps, and (N,) metres
        along the path of the whole ground truth at those.
    """
    served, truth, index = window.interpolate(
        estimate.stamps, round(settings.max_truth_gap * NANOSECONDS))
    if len(truth) < 2:
        raise EvaluationError(_no_overlap(window, estimate, settings, len(truth)))
    travelled = np.interp(index, np.arange(len(window)), window.path_lengths())
    return truth, estimate.selected(served), travelled


def _no_overlap(window, estimate, settings, count):
    def span(trajectory):
        return "%.3f to %.3f s" % tuple(trajectory.stamps[[0, -1]] / NANOSECONDS)

    problem = "%d of its %d poses have ground truth at their time, 2 are needed" % (
        count, len(estimate))
    if estimate.stamps[-1] < window.stamps[0] or estimate.stamps[0] > window.stamps[-1]:
        return "%s: it covers %s, the evaluated ground truth %s" % (
            problem, span(estimate), span(window))
    gap = float(np.median(np.diff(window.stamps))) / NANOSECONDS
    return ("%s: the ground truth's poses are %.3f s apart (median), and it is interpolated "
            "over at most %g s (--max-truth-gap)" % (problem, gap, settings.max_truth_gap))


def _relative(result, travelled, distances):
    if not (result.truth.has_orientation and result.estimate.has_orientation):
        return []
    return [relative_error.relative_errors(result.truth, result.estimate, travelled, distance)
            for distance in distances]
