"""Plots of an Evaluation, each as an <svg> element.

The plots have no legend: colours belong to the estimates by their order, and
the page shows them once (colour()).
"""

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from vins_evaluation.style import STYLE, TRUTH_COLOUR, colour
from vins_evaluation.svg import inline_svg
from vins_evaluation.trajectory import NANOSECONDS

# More than a plot of this size can show.
_MOST_POINTS = 4000


def top_view(evaluation):
    """Paths in x and y, metres, both axes alike."""
    return _view(evaluation, "top", (0, 1), "Top view of the paths")


def side_view(evaluation):
    """Paths in x and z, metres, both axes alike."""
    return _view(evaluation, "side", (0, 2), "Side view of the paths")


def position_error(evaluation):
    """Length of the position error over time."""
    with matplotlib.rc_context(STYLE):
        figure = _figure(10.0, 2.6)
        axes = figure.add_subplot(1, 1, 1)
        for index, result in enumerate(evaluation.results):
            _plot_over_time(axes, evaluation, result, result.absolute.position, index)
        axes.set_ylim(bottom=0.0)
        axes.set_ylabel("position error [m]")
        _finish_time_axis(axes, evaluation)
        return inline_svg(figure, "position-error", "Position error over time")


def component_errors(evaluation):
    """Errors in x, y, z and yaw over time, with their signs."""
    rows = [("x [m]", 0), ("y [m]", 1), ("z [m]", 2)]
    if any(result.absolute.yaw is not None for result in evaluation.results):
        rows.append(("yaw [deg]", None))
    with matplotlib.rc_context(STYLE):
        figure = _figure(10.0, 1.3 * len(rows) + 0.4)
        first = None
        for number, (label, component) in enumerate(rows, 1):
            axes = figure.add_subplot(len(rows), 1, number, sharex=first)
            first = first or axes
            _plot_component(axes, evaluation, component)
            axes.set_ylabel(label)
            axes.tick_params(labelbottom=number == len(rows))
        figure.align_ylabels()
        _finish_time_axis(axes, evaluation)
        return inline_svg(figure, "component-errors", "Errors in x, y, z and yaw over time")


def relative_errors(evaluation):
    """Box plots of the relative errors over distances."""
    with matplotlib.rc_context(STYLE):
        figure = _figure(10.0, 3.2)
        panels = (("translation_percent", "translation error [%]"),
                  ("rotation", "rotation error [deg]"))
        for number, (series, label) in enumerate(panels, 1):
            axes = figure.add_subplot(1, 2, number)
            for index, result in enumerate(evaluation.results):
                _boxes(axes, result.relative, series, index, len(evaluation.results))
            _finish_distance_axis(axes, evaluation.distances)
            axes.set_ylabel(label)
        return inline_svg(figure, "relative-errors", "Relative errors over distances")


def _figure(width, height):
    return Figure(figsize=(width, height), constrained_layout=True)


def _view(evaluation, name, axis_numbers, title):
    with matplotlib.rc_context(STYLE):
        figure = _figure(5.0, 4.6)
        axes = figure.add_subplot(1, 1, 1)
        truth = evaluation.truth.positions[:, axis_numbers]
        _path(axes, truth[_thinned(len(truth))], TRUTH_COLOUR, 2.2)
        for index, result in enumerate(evaluation.results):
            positions = result.estimate.positions[:, axis_numbers]
            which = _thinned(len(positions))
            path = _broken_at_gaps(positions, which, _runs(evaluation, result))
            _path(axes, path, colour(index), 1.1)
        axes.set_aspect("equal", adjustable="datalim")
        axes.set_xlabel("%s [m]" % "xyz"[axis_numbers[0]])
        axes.set_ylabel("%s [m]" % "xyz"[axis_numbers[1]])
        return inline_svg(figure, name, title)


def _path(axes, path, its_colour, width):
    """A path with a disc at its start and a square at its end."""
    axes.plot(path[:, 0], path[:, 1], color=its_colour, linewidth=width)
    for point, marker in ((path[0], "o"), (path[-1], "s")):
        axes.plot(*point, marker=marker, markersize=5.0 + width, zorder=4,
                  markerfacecolor="white", markeredgecolor=its_colour, markeredgewidth=1.4)


def _plot_over_time(axes, evaluation, result, errors, index):
    curve = np.stack([result.times, errors], axis=1)
    curve = _broken_at_gaps(curve, _peaks(errors), _runs(evaluation, result))
    axes.plot(curve[:, 0], curve[:, 1], color=colour(index))


def _plot_component(axes, evaluation, component):
    axes.axhline(0.0, color=TRUTH_COLOUR, linewidth=0.8)
    for index, result in enumerate(evaluation.results):
        errors = result.absolute.yaw
        if component is not None:
            errors = result.absolute.vectors[:, component]
        if errors is not None:
            _plot_over_time(axes, evaluation, result, errors, index)


def _finish_time_axis(axes, evaluation):
    axes.set_xlim(0.0, evaluation.truth.duration)
    axes.set_xlabel("time since the first pose of the ground truth [s]")


def _boxes(axes, relative, series, index, count):
    """Boxes of one estimate, shifted beside those of the others."""
    width = 0.7 / count
    kept = [(number, errors) for number, errors in enumerate(relative) if len(errors)]
    if not kept:
        return
    shift = (index - (count - 1) / 2.0) * width
    line = {"color": colour(index), "linewidth": 1.1}
    axes.boxplot([getattr(errors, series) for _, errors in kept],
                 positions=[number + shift for number, _ in kept],
                 widths=0.8 * width, whis=(5, 95), showfliers=False, patch_artist=True,
                 manage_ticks=False, whiskerprops=line, capprops=line,
                 medianprops={"color": "white", "linewidth": 1.6},
                 boxprops={"facecolor": colour(index), "edgecolor": colour(index)})


def _finish_distance_axis(axes, distances):
    axes.set_xticks(range(len(distances)))
    axes.set_xticklabels(["%g m" % distance for distance in distances])
    axes.set_xlim(-0.6, len(distances) - 0.4)
    axes.set_ylim(bottom=0.0)
    axes.grid(False, axis="x")
    axes.set_xlabel("length of the sub-trajectories")


def _thinned(count):
    """Indices of at most about _MOST_POINTS of count points, with both ends."""
    step = max(1, -(-count // _MOST_POINTS))
    return np.unique(np.append(np.arange(0, count, step), count - 1))


def _peaks(errors):
    """As _thinned, but of each stretch the largest error: no peak gets lost."""
    step = max(1, -(-len(errors) // _MOST_POINTS))
    starts = range(0, len(errors), step)
    return np.array([start + int(np.argmax(np.abs(errors[start:start + step])))
                     for start in starts])


def _runs(evaluation, result):
    """The number of the run without gaps that each pose belongs to, (N,)."""
    max_gap_ns = round(evaluation.settings.max_gap * NANOSECONDS)
    gaps = np.diff(result.estimate.stamps) > max_gap_ns
    return np.concatenate([[0], np.cumsum(gaps)])


def _broken_at_gaps(points, which, runs):
    """Some of points (N, 2), with a row of NaN, where a line stops, in every gap.

    The gaps are those between the poses, not those that drawing fewer leaves.
    """
    ends = np.flatnonzero(np.diff(runs[which])) + 1
    return np.insert(points[which], ends, np.nan, axis=0)
