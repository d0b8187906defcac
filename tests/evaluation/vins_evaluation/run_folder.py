"""What run_bag has written into its folder."""

import collections
import csv
import json
import os

import numpy as np

from vins_evaluation import sources
from vins_evaluation.errors import EvaluationError

# A line of events.csv: stamp [ns], code, {name: number}.
Event = collections.namedtuple("Event", "stamp code figures")


class RunFolder:
    """Reads its files, each when it is asked for.

    Args:
        path: the folder that was run_bag's --out.
    """

    def __init__(self, path):
        self.path = path

    def file(self, name):
        """The path of a file that must be there.

        Raises:
            EvaluationError where it is not.
        """
        path = os.path.join(self.path, name)
        if not os.path.isfile(path):
            raise EvaluationError("%s: is not there; run run_bag anew" % path)
        return path

    def trajectory(self, name):
        """The LoadedTrajectory of vio_live, loop_live, loop_final or ground_truth."""
        return sources.load(self.file(name + ".txt"))

    def table(self, name):
        """A csv file with a line of names, as {column: (N,) floats, stamps as int64}.

        Units in the names, as in "stamp [ns]", are left out.
        """
        return read_table(self.file(name + ".csv"))

    def events(self):
        """List of Event, as they came."""
        with open(self.file("events.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.reader(file))[1:]
        return [Event(int(row[0]), row[2], _figures(row[4])) for row in rows]

    def stages(self):
        """{stage: {"count", "mean_ms", "median_ms", "p95_ms", ...}}, of timing.json."""
        with open(self.file("timing.json"), encoding="utf-8") as file:
            return json.load(file)["stages"]


def read_table(path):
    """As RunFolder.table, of any file.

    Raises:
        EvaluationError where it has no line, or a field is no number.
    """
    with open(path, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    if len(rows) < 2:
        raise EvaluationError("%s: has no line" % path)
    names = [name.lstrip("#").split(" [")[0] for name in rows[0]]
    try:
        return {name: np.array([int(row[i]) if name == "stamp" else float(row[i])
                                for row in rows[1:]])
                for i, name in enumerate(names)}
    except (ValueError, IndexError) as error:
        raise EvaluationError("%s: %s" % (path, error)) from error


def _figures(text):
    pairs = [pair.split("=", 1) for pair in text.split()]
    return {name: float(value) for name, value in pairs}
