"""The checks that every pose passes on its way from a file or a bag."""

import math

from vins_evaluation.errors import EvaluationError
from vins_evaluation.trajectory import Trajectory

# Text files with three decimals still pass; a swapped column does not.
QUATERNION_NORM_TOLERANCE = 1e-2
MAX_STAMP_NS = 2**63 - 1


class PoseCollector:
    """Takes poses one by one and complains by place about the first bad one.

    Args:
        source: what the user called the file or topic, for messages.
        unit: what its records are called ("line", "message"), for messages.
    """

    def __init__(self, source, unit):
        self._source = source
        self._unit = unit
        self._rows = []
        self._numbers = []
        self._repeated = []

    def fail(self, number, problem):
        """Raise an EvaluationError about record number."""
        raise EvaluationError(
            "%s, %s %d: %s" % (self._source, self._unit, number, problem))

    def add(self, number, stamp, position, quaternion=None):
        """Check and keep a pose.

        Args:
            number: the record's number in its source, from 1.
            stamp: nanoseconds, int.
            position: 3 floats, metres.
            quaternion: 4 floats x y z w, or None (then in every record).
        """
        if abs(stamp) > MAX_STAMP_NS:
            self.fail(number, "stamp of %.4g s is out of range (nanoseconds where "
                              "seconds belong?)" % (stamp * 1e-9))
        if not all(map(math.isfinite, position)):
            self.fail(number, "position is not finite: %s" % _listed(position))
        if quaternion is not None:
            self._check_quaternion(number, quaternion)
        row = (stamp, tuple(position), quaternion and tuple(quaternion))
        if self._is_new(number, row):
            self._rows.append(row)
            self._numbers.append(number)

    def _check_quaternion(self, number, quaternion):
        norm = math.sqrt(sum(value * value for value in quaternion))
        if not abs(norm - 1.0) <= QUATERNION_NORM_TOLERANCE:
            self.fail(number, "quaternion x y z w = %s has norm %.4g, 1 +- %g expected"
                      % (_listed(quaternion), norm, QUATERNION_NORM_TOLERANCE))

    def _is_new(self, number, row):
        if not self._rows or row[0] > self._rows[-1][0]:
            return True
        where = "%s %d" % (self._unit, self._numbers[-1])
        if row == self._rows[-1]:
            self._repeated.append(number)
            return False
        if row[0] == self._rows[-1][0]:
            self.fail(number, "same stamp as %s but another pose" % where)
        self.fail(number, "stamp goes back by %.9f s after %s"
                  % ((self._rows[-1][0] - row[0]) * 1e-9, where))

    def trajectory(self):
        """The Trajectory of all poses taken; an error if there was none."""
        if not self._rows:
            raise EvaluationError("%s: no poses in it" % self._source)
        stamps, positions, quaternions = zip(*self._rows)
        known = quaternions[0] is not None
        return Trajectory(stamps, positions, quaternions if known else None)

    def warnings(self):
        """What the user should hear although it is no error: list of str."""
        if not self._repeated:
            return []
        return ["%s: dropped %d repeated pose(s), the first at %s %d"
                % (self._source, len(self._repeated), self._unit, self._repeated[0])]


def _listed(values):
    return " ".join("%.6g" % value for value in values)
