"""Trajectories in text files, recognised by what is in them.

  TUM      `stamp tx ty tz qx qy qz qw`, stamp in seconds, split by blanks
           (Sturm et al. 2012); or only `stamp tx ty tz`
  csv      `stamp, px, py, pz, qw, qx, qy, qz, ...`, stamp in nanoseconds:
           EuRoC's state_groundtruth_estimate0/data.csv and the results that
           VINS-Mono writes (with a comma at the end); columns after the
           eighth are not read; or only `stamp, px, py, pz` (EuRoC's Leica)

Lines that begin with # and empty lines are skipped everywhere.
"""

from decimal import Decimal, InvalidOperation

from vins_evaluation.errors import EvaluationError
from vins_evaluation.pose_collector import PoseCollector


def read_trajectory_file(path):
    """Read a trajectory.

    Returns:
        its Trajectory and a list of warnings (str).
    Raises:
        EvaluationError naming the file, and the line where there is one.
    """
    collector = PoseCollector(path, "line")
    layout = None
    for number, line in _data_lines(path):
        if layout is None:
            layout = _layout_of(line, number, collector)
        _add_line(line, number, layout, collector)
    return collector.trajectory(), collector.warnings()


def _data_lines(path):
    """Yield (line number, stripped line) of all but comments and empty lines."""
    try:
        with open(path, encoding="utf-8-sig") as file:
            for number, line in enumerate(file, 1):
                line = line.strip()
                if line and not line.startswith("#"):
                    yield number, line
    except OSError as error:
        raise EvaluationError("%s: cannot read it: %s" % (path, error.strerror)) from error
    except UnicodeDecodeError as error:
        raise EvaluationError(
            "%s: not a text file (a topic of a bag is given as FILE.bag:/topic)"
            % path) from error


class _Tum:
    """Blanks between the values, seconds, x y z w."""

    separator = None
    form = "TUM: stamp tx ty tz qx qy qz qw"
    extra_columns = False

    @staticmethod
    def stamp(value):
        """Seconds as nanoseconds: all decimals kept, which a double could not."""
        return int(value.scaleb(9).to_integral_value())

    @staticmethod
    def quaternion(values):
        return values


class _Csv:
    """Commas between the values, nanoseconds, w x y z."""

    separator = ","
    form = "csv: stamp, px, py, pz, qw, qx, qy, qz, ..."
    extra_columns = True

    @staticmethod
    def stamp(value):
        if value != value.to_integral_value():
            raise ValueError("stamp %s is not a whole number of nanoseconds" % value)
        return int(value)

    @staticmethod
    def quaternion(values):
        return values[1:] + values[:1]


class _Layout:
    """A format and how many columns of it the file has."""

    def __init__(self, form, columns):
        self.form = form
        self.columns = columns


def _fields(line, form):
    fields = line.rstrip(",").split(form.separator) if form.separator else line.split()
    return [field.strip() for field in fields]


def _layout_of(line, number, collector):
    form = _Csv if "," in line else _Tum
    count = len(_fields(line, form))
    if count == 4 or count == 8 or (count > 8 and form.extra_columns):
        return _Layout(form, count)
    return collector.fail(
        number, "%d values, which is neither a pose (%s) nor a position (4 values)"
        % (count, form.form))


def _add_line(line, number, layout, collector):
    fields = _fields(line, layout.form)
    if len(fields) != layout.columns:
        collector.fail(number, "%d values where the lines above have %d"
                       % (len(fields), layout.columns))
    try:
        stamp = layout.form.stamp(_finite_decimal(fields[0]))
        values = [float(field) for field in fields[1:8]]
    except ValueError as error:
        collector.fail(number, str(error))
    quaternion = layout.form.quaternion(values[3:]) or None
    collector.add(number, stamp, values[:3], quaternion)


def _finite_decimal(text):
    try:
        value = Decimal(text)
    except InvalidOperation:
        raise ValueError("stamp %r is not a number" % text) from None
    if not value.is_finite() or value.adjusted() > 30:
        raise ValueError("stamp %r is not finite or far too large" % text)
    return value
