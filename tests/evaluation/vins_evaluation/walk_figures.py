"""What run_bag makes of one simulated walk: start, resets, coverage, accuracy, consistency."""

import collections

import numpy as np
import yaml

from vins_evaluation import alignment, metrics
from vins_evaluation.errors import EvaluationError
from vins_evaluation.run_folder import RunFolder
from vins_evaluation.trajectory import NANOSECONDS

# Motion is sufficient to start with once the last second's path is this long, metres.
SUFFICIENT_PATH = 0.1
# Between two poses at most so far apart the estimate counts as there, seconds.
_MAX_GAP = 1.0
_MAX_TRUTH_GAP = NANOSECONDS // 10

# Seconds from the walk's begin to its first sufficient motion; from there to the first pose
# (negative: at rest, before it); resets; percent of the time since that motion with poses; metres
# of the true path while there are poses; ATE in percent of it; NEES per degree of freedom; error
# of td, seconds. None: not known.
WalkFigures = collections.namedtuple(
    "WalkFigures", "motion_s first_pose_s resets coverage path_m ate_percent nees_position "
    "nees_rotation td_error_s")


def sufficient_motion(truth):
    """Seconds from a Trajectory's first pose to its first sufficient motion; None: never."""
    seconds = (truth.stamps - truth.stamps[0]) / NANOSECONDS
    path = truth.path_lengths()
    second_before = np.interp(seconds - 1.0, seconds, path)
    moved = np.flatnonzero(path - second_before >= SUFFICIENT_PATH)
    return float(seconds[moved[0]]) if len(moved) else None


def read_rig(path):
    """What a rig's file, as simulate_bag writes it, has: a dictionary."""
    with open(path, encoding="utf-8") as file:
        text = "".join(line for line in file if not line.startswith("%"))
    return yaml.load(text, Loader=_OpenCvLoader)


def read_truth(true_rig_path, readout_is_known=False):
    """When the body was where an image shows it, by the true rig.

    Args:
        true_rig_path: the true rig.
        readout_is_known: the estimator has the read-out, or estimates it: its poses are those of
            the first row's time. Otherwise they are those of the middle row's.
    Returns:
        the time offset that it should find, and how much later than the first row its poses are,
        seconds.
    """
    rig = read_rig(true_rig_path)
    late = 0.0 if readout_is_known else 0.5 * rig["rolling_shutter_tr"]
    return rig["td"] + late, late


class _OpenCvLoader(yaml.SafeLoader):
    """Reads OpenCV's matrices as mappings."""


_OpenCvLoader.add_constructor("tag:yaml.org,2002:opencv-matrix",
                              lambda loader, node: loader.construct_mapping(node, deep=True))


def read_walk(run_path, true_rig_path, readout_is_known=False):
    """WalkFigures of a folder that run_bag has written.

    Args:
        run_path: the folder.
        true_rig_path, readout_is_known: see read_truth().
    Raises:
        EvaluationError where a file is missing or broken.
    """
    run = RunFolder(run_path)
    truth = run.trajectory("ground_truth").trajectory
    motion = sufficient_motion(truth)
    try:
        table = run.table("estimator")
    except EvaluationError:
        return WalkFigures(motion, None, 0, 0.0, 0.0, None, None, None, None)
    td, late = read_truth(true_rig_path, readout_is_known)
    estimate = run.trajectory("vio_live").trajectory.shifted(round(late * NANOSECONDS))
    begin = truth.stamps[0] + round((motion or 0.0) * NANOSECONDS)
    moving = truth.stamps[truth.stamps >= begin]
    coverage = metrics.Coverage(moving, estimate.stamps, _MAX_GAP).completeness
    first = float(estimate.stamps[0] - begin) / NANOSECONDS
    served, true_poses, _ = truth.interpolate(estimate.stamps, _MAX_TRUTH_GAP)
    path, ate = _accuracy(true_poses, estimate.selected(served))
    position, rotation = consistency(true_poses, estimate.selected(served),
                                     {name: column[served] for name, column in table.items()})
    return WalkFigures(motion, first, int(table["sequence"][-1]), coverage, path, ate, position,
                       rotation, float(table["td"][-1]) - td)


def _accuracy(truth, estimate):
    """Metres of the true path, and the ATE in percent of it; None where there is no answer."""
    path = float(truth.path_lengths()[-1]) if len(truth) else 0.0
    if len(truth) < 2:
        return path, None
    try:
        fitted = alignment.align("posyaw", truth.positions, estimate.positions).apply(estimate)
    except EvaluationError:
        return path, None
    errors = np.linalg.norm(fitted.positions - truth.positions, axis=1)
    return path, 100.0 * float(np.sqrt(np.mean(errors**2))) / path


def consistency(truth, estimate, table):
    """NEES per degree of freedom of position and of rotation: 1 is right, more too confident.

    Each run between two resets is laid onto the truth by its first pose, for its errors grow from
    there; the mean over all poses but those first ones. Of the covariance its diagonal is known.
    """
    position, rotation = [], []
    for sequence in np.unique(table["sequence"]):
        which = np.flatnonzero(table["sequence"] == sequence)
        if len(which) < 2:
            continue
        part = truth.selected(which)
        errors = metrics.AbsoluteErrors(
            part, alignment.laid_onto_first(part, estimate.selected(which)))
        sigma = {name: np.maximum(table[name][which], 1e-9) for name in table}
        axes = np.column_stack([sigma["sigma_px"], sigma["sigma_py"], sigma["sigma_pz"]])
        position.append(np.mean((errors.vectors / axes)[1:]**2, axis=1))
        yaw, tilt = errors.yaw / sigma["sigma_yaw"], errors.tilt / sigma["sigma_tilt"]
        # The tilt has two degrees of freedom, its deviation is that of both together.
        rotation.append(((yaw**2 + 2.0 * tilt**2) / 3.0)[1:])
    if not position:
        return None, None
    return float(np.mean(np.concatenate(position))), float(np.mean(np.concatenate(rotation)))


def text_table(walks):
    """A line for each walk.

    Args:
        walks: {name: WalkFigures}.
    """
    heading = ("walk", "motion [s]", "first pose [s]", "resets", "coverage [%]", "path [m]",
               "ATE [%]", "NEES p", "NEES R", "td error [ms]")
    rows = [heading] + [(name,) + _cells(figures) for name, figures in walks.items()]
    widths = [max(len(row[i]) for row in rows) for i in range(len(heading))]
    return "\n".join("  ".join(cell.rjust(width) for cell, width in zip(row, widths))
                     for row in rows) + "\n"


def summary(walks):
    """How many walks meet what issue and users ask for, in a few lines."""
    figures = list(walks.values())

    def count(condition):
        return "%d of %d" % (sum(1 for f in figures if condition(f)), len(figures))

    started = [f for f in figures if f.first_pose_s is not None]
    lines = ["started at all: %s" % count(lambda f: f.first_pose_s is not None),
             "within 1.5 s of motion: %s"
             % count(lambda f: f.first_pose_s is not None and f.first_pose_s <= 1.5),
             "without a reset: %s" % count(lambda f: f in started and f.resets == 0),
             "ATE below 1.5 %%: %s"
             % count(lambda f: f.ate_percent is not None and f.ate_percent < 1.5)]
    for name in ("nees_position", "nees_rotation"):
        lines.append("%s within 0.5 to 2: %s" % (name, count(
            lambda f, name=name: getattr(f, name) is not None and 0.5 <= getattr(f, name) <= 2.0)))
    return "\n".join(lines) + "\n"


def _cells(f):
    def text(form, value, factor=1.0):
        return "-" if value is None else form % (factor * value)

    return (text("%.2f", f.motion_s), text("%+.2f", f.first_pose_s), "%d" % f.resets,
            "%.1f" % f.coverage, "%.1f" % f.path_m, text("%.2f", f.ate_percent),
            text("%.2f", f.nees_position), text("%.2f", f.nees_rotation),
            text("%+.1f", f.td_error_s, 1e3))
