"""Figures of what evaluate_places has measured."""

import glob
import os

import matplotlib
from matplotlib.figure import Figure

from vins_evaluation.errors import EvaluationError
from vins_evaluation.run_folder import read_table
from vins_evaluation.style import COLOURS, STYLE

# A candidate needs this much of the score of the keyframe before: min-normalized-score.
_DEFAULT_THRESHOLD = 0.3


def recall(folder):
    """Precision over recall of the best answers, and both over the threshold.

    Args:
        folder: evaluate_places' --out.
    """
    curves = sorted(glob.glob(os.path.join(folder, "*_curve.csv")))
    if not curves:
        raise EvaluationError("%s: has no *_curve.csv; run evaluate_places anew" % folder)
    table = read_table(curves[0])
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(8.0, 3.0), layout="constrained")
        left, right = figure.subplots(1, 2, sharey=True)
        left.plot(100.0 * table["recall"], 100.0 * table["precision"], color=COLOURS[0])
        left.set_xlabel("recall [%]: of the places seen before")
        left.set_ylabel("[%]")
        left.set_title("precision over recall", fontsize=9)
        left.set_xlim(0.0, 100.0)
        left.set_ylim(0.0, 104.0)
        right.plot(table["normalized_score"], 100.0 * table["precision"], color=COLOURS[0],
                   label="precision")
        right.plot(table["normalized_score"], 100.0 * table["recall"], color=COLOURS[1],
                   label="recall")
        right.axvline(_DEFAULT_THRESHOLD, color=COLOURS[2], linestyle="--", label="threshold")
        right.set_xlabel("score, over that of the keyframe before")
        right.set_title("over the threshold", fontsize=9)
        right.set_xlim(left=0.0)
        right.legend(loc="center right", frameon=False)
        return figure
