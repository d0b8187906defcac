"""The figures that the reports show: label, unit, decimals, and which is best."""

NOT_KNOWN = "-"


class Figure:
    """One figure of each estimate.

    Attributes:
        label, unit: for display.
        decimals: digits after the point.
        values: one a estimate, float or int; None where it is not known.
        best: index of the best value; None where no one is better than all
            others or the figure has no better and worse.
    """

    def __init__(self, label, unit, decimals, values, rank=None):
        """Args: rank: from a value to what is to be small; None: not ranked."""
        self.label = label
        self.unit = unit
        self.decimals = decimals
        self.values = values
        self.best = self._best(rank)

    def _best(self, rank):
        texts = [self.text(index) for index in range(len(self.values))]
        known = [index for index, value in enumerate(self.values) if value is not None]
        if rank is None or len(known) < 2:
            return None
        best = min(known, key=lambda index: rank(self.values[index]))
        # What looks alike in the table is not worth a prize.
        return best if texts.count(texts[best]) == 1 else None

    def text(self, index):
        """The value of estimate number index as text."""
        value = self.values[index]
        if value is None:
            return NOT_KNOWN
        # Adding 0 turns a rounded -0 into 0.
        return "%.*f" % (self.decimals, round(value, self.decimals) + 0)


def _low(value):
    return value


def _high(value):
    return -value


def overall(evaluation):
    """[(heading, [Figure])] of the whole trajectories.

    A group that is known of no estimate (rotations, where there are only
    positions) is left out.
    """
    results = evaluation.results
    groups = [
        ("Coverage", _coverage(results)),
        ("Position error (ATE)", _errors(results, "position", "m", 4)),
        ("Rotation error", _errors(results, "rotation", "deg", 3)),
        ("Yaw and gravity direction", _yaw_and_tilt(results)),
        ("Scale", [Figure("scale error", "%", 2,
                          [result.scale_error for result in results], abs)]),
    ]
    return [(heading, group) for heading, group in groups
            if any(value is not None for figure in group for value in figure.values)]


def _coverage(results):
    return [
        Figure("completeness", "%", 2,
               [result.coverage.completeness for result in results], _high),
        Figure("longest gap", "s", 3,
               [result.coverage.longest_gap for result in results], _low),
        Figure("first pose after", "s", 3,
               [result.coverage.first_pose for result in results], _low),
        Figure("poses compared", "", 0, [len(result.estimate) for result in results]),
    ]


def _errors(results, series, unit, decimals):
    return [_statistic(results, series, name, name, unit, decimals)
            for name in ("rmse", "mean", "median", "max")]


def _yaw_and_tilt(results):
    return [_statistic(results, "yaw", "rmse", "yaw rmse", "deg", 3),
            _statistic(results, "yaw", "max", "yaw max", "deg", 3),
            _statistic(results, "tilt", "rmse", "tilt rmse", "deg", 3),
            _statistic(results, "tilt", "max", "tilt max", "deg", 3)]


def _statistic(results, series, name, label, unit, decimals):
    every = [result.statistics(series) for result in results]
    return Figure(label, unit, decimals, _picked(every, name), _low)


def _picked(every, name):
    """One number of each Statistics; None where there is none."""
    return [None if statistics is None else getattr(statistics, name)
            for statistics in every]


# heading, unit, decimals, series of RelativeErrors, statistic
_RELATIVE = (
    ("translation rmse", "m", 4, "translation", "rmse"),
    ("translation median", "m", 4, "translation", "median"),
    ("translation mean", "%", 3, "translation_percent", "mean"),
    ("rotation rmse", "deg", 3, "rotation", "rmse"),
    ("rotation mean", "deg/m", 4, "rotation_per_metre", "mean"),
)


def over_distances(evaluation):
    """[(distance in metres, [Figure])]; None where an estimate has no rotations."""
    return [(distance, _relative_figures(evaluation.results, index))
            for index, distance in enumerate(evaluation.distances)]


def _relative_figures(results, index):
    errors = [result.relative[index] if result.relative else None for result in results]
    figures = [Figure("sub-trajectories", "", 0,
                      [None if error is None else len(error) for error in errors])]
    for label, unit, decimals, series, name in _RELATIVE:
        every = [None if error is None else error.statistics(series) for error in errors]
        figures.append(Figure(label, unit, decimals, _picked(every, name), _low))
    return figures
