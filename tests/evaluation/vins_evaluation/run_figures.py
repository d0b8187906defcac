"""Figures of one run of run_bag, for the pages on how it works.

Each takes a RunFolder and gives a matplotlib Figure, or raises EvaluationError for files that are
missing or cannot be read.
"""

import matplotlib
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from vins_evaluation import alignment, evaluation, rotations
from vins_evaluation.errors import EvaluationError
from vins_evaluation.metrics import AbsoluteErrors
from vins_evaluation.style import COLOURS, STYLE, TRUTH_COLOUR
from vins_evaluation.trajectory import NANOSECONDS

_WIDTH = 8.0  # inches
_END = 4 * NANOSECONDS  # of a path, looked at closely
_MAX_TRUTH_GAP = round(0.1 * NANOSECONDS)

# What was waited for, in fewer words than the event's own.
_WAITED_FOR = {
    "init_few_tracks": "too few tracks",
    "init_little_parallax": "too little parallax",
    "init_little_excitation": "too little acceleration",
    "init_inconsistent": "no rigid scene",
}

# Of timing.json, with what they are part of.
_STAGES = (
    ("tracker", "feature tracker", 0),
    ("estimator", "estimator", 1),
    ("estimator/solve", "    window's adjustment", 1),
    ("estimator/marginalize", "    marginalization", 1),
    ("pose_graph/describe", "pose graph: describe a keyframe", 2),
    ("pose_graph/query", "    query", 2),
    ("pose_graph/verify", "    verify a candidate", 2),
    ("pose_graph/optimize", "    optimize the graph", 2),
)


def tracks(run):
    """How many tracks there are in each image, and how long they are."""
    table = run.table("tracker")
    seconds = (table["stamp"] - table["stamp"][0]) / NANOSECONDS
    with matplotlib.rc_context(STYLE):
        figure = _figure(3.6)
        upper, lower = figure.subplots(2, 1, sharex=True)
        upper.fill_between(seconds, table["inliers"], color=COLOURS[0], alpha=0.25, linewidth=0,
                           label="followed from the image before")
        upper.fill_between(seconds, table["inliers"], table["inliers"] + table["detected"],
                           color=COLOURS[2], alpha=0.5, linewidth=0, label="found anew")
        lost = table["before"] - table["tracked"]
        rejected = table["tracked"] - table["inliers"]
        upper.plot(seconds, lost, color=COLOURS[1], linewidth=0.8, label="lost by the flow")
        upper.plot(seconds, rejected, color=TRUTH_COLOUR, linewidth=0.8,
                   label="rejected as outliers")
        upper.set_ylabel("tracks")
        upper.set_ylim(bottom=0)
        upper.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
        lower.plot(seconds, table["mean_track_length"], color=COLOURS[0])
        lower.set_ylabel("mean length\nof a track [images]")
        lower.set_ylim(bottom=0)
        _finish_time(lower, seconds)
        figure.align_ylabels()
        return figure


def errors(run):
    """Error of position and yaw over time, and three standard deviations of each."""
    table = run.table("estimator")
    truth, estimate, kept = _associated(run, table["stamp"])
    absolute = AbsoluteErrors(truth, alignment.laid_onto_first(truth, estimate))
    seconds = (truth.stamps - truth.stamps[0]) / NANOSECONDS
    rows = [("%s [cm]" % "xyz"[i], 100.0 * absolute.vectors[:, i],
             100.0 * table["sigma_p" + "xyz"[i]][kept]) for i in range(3)]
    rows.append(("yaw [deg]", absolute.yaw, table["sigma_yaw"][kept]))
    with matplotlib.rc_context(STYLE):
        figure = _figure(5.0)
        for axes, (label, error, sigma) in zip(figure.subplots(4, 1, sharex=True), rows):
            axes.fill_between(seconds, -3.0 * sigma, 3.0 * sigma, color=COLOURS[0], alpha=0.18,
                              linewidth=0, label="three standard deviations")
            axes.plot(seconds, error, color=COLOURS[1], label="error")
            axes.axhline(0.0, color=TRUTH_COLOUR, linewidth=0.6)
            axes.set_ylabel(label)
        figure.axes[0].legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.0),
                              frameon=False)
        _finish_time(figure.axes[-1], seconds, "time since the first odometry [s]")
        figure.align_ylabels()
        return figure


def start(run):
    """The true speed at the start of a run, what was waited for, and the first odometry."""
    begin = int(run.table("tracker")["stamp"][0])
    waits = [event for event in run.events() if event.code in _WAITED_FOR]
    table, speeds = run.table("estimator"), _velocities(run)
    first = int(table["stamp"][0])
    end = first + round(1.5 * NANOSECONDS)
    with matplotlib.rc_context(STYLE):
        figure = _figure(3.0)
        axes = figure.add_subplot(1, 1, 1)
        stamps, speed = _true_speed(run.trajectory("ground_truth").trajectory, begin, end)
        axes.plot((stamps - begin) / NANOSECONDS, speed, color=TRUTH_COLOUR, linewidth=1.8,
                  label="true speed")
        shown = table["stamp"] <= end
        seconds = (table["stamp"][shown] - begin) / NANOSECONDS
        sigma = np.sqrt(sum(table["sigma_v" + axis][shown]**2 for axis in "xyz"))
        axes.fill_between(seconds, speeds[shown] - 3.0 * sigma, speeds[shown] + 3.0 * sigma,
                          color=COLOURS[0], alpha=0.18, linewidth=0,
                          label="three standard deviations")
        axes.plot(seconds, speeds[shown], color=COLOURS[0], label="estimated speed")
        _mark(axes, (first - begin) / NANOSECONDS, "initialised", COLOURS[2])
        for event in waits:
            if event.stamp < first:
                _mark(axes, (event.stamp - begin) / NANOSECONDS,
                      "waiting:\n" + _WAITED_FOR[event.code], COLOURS[1])
        axes.set_ylim(bottom=0.0)
        axes.set_xlim(0.0, (end - begin) / NANOSECONDS)
        axes.set_ylabel("speed [m/s]")
        axes.set_xlabel("time since the first image [s]")
        axes.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.16), frameon=False)
        return figure


def stage_times(run):
    """Mean and 95th percentile of the time of each stage's work, and how often it was done."""
    stages = run.stages()
    rows = [(stages[key], name, number) for key, name, number in _STAGES if key in stages]
    if not rows:
        raise EvaluationError("%s: names no stage that is known" % run.file("timing.json"))
    with matplotlib.rc_context(STYLE):
        figure = _figure(0.5 + 0.32 * len(rows))
        axes = figure.add_subplot(1, 1, 1)
        for at, (stage, _, number) in enumerate(rows):
            axes.barh(at, stage["mean_ms"], height=0.62, color=COLOURS[number])
            axes.plot([stage["mean_ms"], stage["p95_ms"]], [at, at], color=TRUTH_COLOUR,
                      marker="|", markevery=[1], linewidth=1.2)
            axes.annotate("%.1f ms, %d times" % (stage["mean_ms"], stage["count"]),
                          (max(stage["mean_ms"], stage["p95_ms"]), at), (6, 0),
                          textcoords="offset points", va="center", color="#333333")
        axes.set_yticks(range(len(rows)), [name for _, name, _ in rows], ha="left")
        axes.tick_params(axis="y", pad=175, length=0)
        axes.invert_yaxis()
        axes.set_xlim(0.0, 1.35 * max(stage["p95_ms"] for stage, _, _ in rows))
        axes.set_xlabel("time [ms]; bar: mean, line: up to the 95th percentile")
        axes.grid(False, axis="y")
        return figure


def loops(run):
    """The path with and without loops, the loops, and what they do to the error."""
    truth = run.trajectory("ground_truth")
    names = ("vio_live", "loop_live", "loop_final")
    compared = evaluation.evaluate(truth, [run.trajectory(name) for name in names],
                                   evaluation.Settings(), names)
    found = [event for event in run.events() if event.code == "loop_found"]
    with matplotlib.rc_context(STYLE):
        figure = _figure(6.0)
        axes = figure.subplot_mosaic([["whole", "end"], ["error", "error"]],
                                     height_ratios=(2.0, 1.0), width_ratios=(1.3, 1.0))
        _draw_paths(axes["whole"], compared, found)
        axes["whole"].set_aspect("equal", adjustable="datalim")
        axes["whole"].legend(loc="best")
        _draw_paths(axes["end"], compared, found)
        _look_at_end(axes["end"], compared)
        lower = axes["error"]
        for result, name, colour in zip(compared.results,
                                        ("odometry", "with the loops known then",
                                         "with all loops"), (1, 4, 0)):
            lower.plot(result.times, 100.0 * result.absolute.position, color=COLOURS[colour],
                       label=name)
        begin = compared.truth.stamps[0]
        marks = [(event.stamp - begin) / NANOSECONDS for event in found]
        lower.plot(marks, np.zeros(len(marks)), "|", color=COLOURS[2], markersize=9,
                   clip_on=False, label="a loop was found")
        lower.set_ylim(bottom=0.0)
        lower.set_ylabel("position error [cm]")
        lower.legend(ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)
        _finish_time(lower, compared.results[0].times)
        return figure


def _draw_paths(axes, compared, found):
    estimate, final = compared.results[0].estimate, compared.results[2].estimate
    axes.plot(*compared.truth.positions[::10, :2].T, color="#bbbbbb", linewidth=3.0,
              label="truth")
    axes.plot(*estimate.positions[::2, :2].T, color=COLOURS[1], label="odometry")
    axes.plot(*final.positions[::2, :2].T, color=COLOURS[0], label="with all loops")
    axes.add_collection(LineCollection(_loop_edges(final, found), color=COLOURS[2],
                                       linewidth=1.0, zorder=4, label="loops"))
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")


def _look_at_end(axes, compared):
    """Shows the path's last seconds only, closely."""
    final = compared.results[2].estimate
    last = final.stamps >= final.stamps[-1] - _END
    low, high = final.positions[last, :2].min(axis=0), final.positions[last, :2].max(axis=0)
    half = 0.5 * np.max(high - low) + 0.4
    centre = 0.5 * (low + high)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlim(centre[0] - half, centre[0] + half)
    axes.set_ylim(centre[1] - half, centre[1] + half)
    axes.set_title("the last %d seconds" % (_END // NANOSECONDS), fontsize=9)


def _loop_edges(path, found):
    """Both ends of each loop, (N, 2, 2) metres, by the times that its event tells."""
    seconds = (path.stamps - path.stamps[0]) / NANOSECONDS

    def at(stamp):
        since = (stamp - path.stamps[0]) / NANOSECONDS
        return [np.interp(since, seconds, path.positions[:, axis]) for axis in (0, 1)]

    return [(at(event.stamp), at(event.stamp - event.figures["seconds_ago"] * NANOSECONDS))
            for event in found if "seconds_ago" in event.figures]


def _figure(height):
    return Figure(figsize=(_WIDTH, height), layout="constrained")


def _finish_time(axes, seconds, label="time [s]"):
    axes.set_xlim(seconds[0], seconds[-1])
    axes.set_xlabel(label)


def _mark(axes, second, text, colour):
    axes.axvline(second, color=colour, linewidth=1.2, linestyle="--")
    axes.annotate(text, (second, 1.0), (0, 3), xycoords=("data", "axes fraction"),
                  textcoords="offset points", ha="center", va="bottom", color=colour)


def _associated(run, stamps):
    """Truth and odometry, Trajectories with the same stamps, and which of estimator.csv's stamps
    these are: not every odometry need have a truth."""
    truth = run.trajectory("ground_truth").trajectory
    estimate = run.trajectory("vio_live").trajectory
    if not np.array_equal(estimate.stamps, stamps):
        raise EvaluationError("%s: is of another run than vio_live.txt" % run.file("estimator.csv"))
    served, associated, _ = truth.interpolate(estimate.stamps, _MAX_TRUTH_GAP)
    if not np.any(served) or not associated.has_orientation:
        raise EvaluationError("%s: has no rotation at the odometry's times"
                              % run.file("ground_truth.txt"))
    return associated, estimate.selected(served), served


def _velocities(run):
    """Estimated speeds [m/s], a number for each odometry."""
    table = np.genfromtxt(run.file("vins_result_no_loop.csv"), delimiter=",", usecols=(8, 9, 10))
    return np.linalg.norm(np.atleast_2d(table), axis=1)


def _true_speed(truth, begin, end):
    """Stamps and speeds [m/s] between two stamps, over a twentieth of a second."""
    steps = np.arange(max(begin, truth.stamps[0]), min(end, truth.stamps[-1]), NANOSECONDS // 20)
    served, path, _ = truth.interpolate(steps, _MAX_TRUTH_GAP)
    steps = steps[served]
    if len(steps) < 2:
        return steps[:0], np.zeros(0)
    lengths = np.linalg.norm(np.diff(path.positions, axis=0), axis=1)
    return (steps[1:] + steps[:-1]) // 2, lengths * NANOSECONDS / np.diff(steps)
