"""Stamped poses of one body, and poses between them."""

import numpy as np

from vins_evaluation import rotations

NANOSECONDS = 1000000000


class Trajectory:
    """Poses of a body in a world frame, in strictly rising order of time.

    Attributes:
        stamps: (N,) int64, nanoseconds.
        positions: (N, 3) metres, p_wb.
        quaternions: (N, 4) unit, x y z w, R_wb; None where only positions are
            known (a laser tracker's prism, say).
    """

    def __init__(self, stamps, positions, quaternions=None):
        self.stamps = np.asarray(stamps, dtype=np.int64)
        self.positions = np.asarray(positions, dtype=float).reshape(-1, 3)
        self.quaternions = None
        if quaternions is not None:
            quaternions = np.asarray(quaternions, dtype=float).reshape(-1, 4)
            self.quaternions = rotations.normalized(quaternions)
        self._check()

    def _check(self):
        count = len(self.stamps)
        if len(self.positions) != count:
            raise ValueError("%d stamps, %d positions" % (count, len(self.positions)))
        if self.has_orientation and len(self.quaternions) != count:
            raise ValueError("%d stamps, %d quaternions" % (count, len(self.quaternions)))
        if np.any(np.diff(self.stamps) <= 0):
            raise ValueError("stamps do not rise strictly")

    def __len__(self):
        return len(self.stamps)

    @property
    def has_orientation(self):
        """Whether the poses have quaternions."""
        return self.quaternions is not None

    @property
    def duration(self):
        """Seconds from the first pose to the last."""
        return float(self.stamps[-1] - self.stamps[0]) / NANOSECONDS

    def selected(self, which):
        """The poses that a mask or index array (in rising order) picks."""
        quaternions = self.quaternions[which] if self.has_orientation else None
        return Trajectory(self.stamps[which], self.positions[which], quaternions)

    def shifted(self, offset_ns):
        """The same poses, offset_ns nanoseconds later."""
        return Trajectory(self.stamps + np.int64(offset_ns), self.positions,
                          self.quaternions)

    def path_lengths(self):
        """Metres travelled from the first pose to each pose, (N,)."""
        steps = np.linalg.norm(np.diff(self.positions, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    def interpolate(self, stamps, max_gap_ns):
        """Poses at other times: positions linearly, rotations by slerp.

        Nothing is extrapolated, and nothing is interpolated between two poses
        that are more than max_gap_ns apart; a pose's own time is always served.

        Args:
            stamps: (M,) int64 nanoseconds, strictly rising.
            max_gap_ns: nanoseconds.
        Returns:
            served: (M,) bool, which of the stamps have a pose.
            the Trajectory of those, and (N,) float: where each lies in this
            one's poses (2.25: a quarter of the way from pose 2 to pose 3).
        """
        before = np.searchsorted(self.stamps, stamps, side="right") - 1
        served = (before >= 0) & (stamps <= self.stamps[-1])
        before = np.clip(before, 0, None)
        after = np.minimum(before + 1, len(self) - 1)
        gap = self.stamps[after] - self.stamps[before]
        since = stamps - self.stamps[before]
        served &= (gap <= max_gap_ns) | (since == 0)
        before, after = before[served], after[served]
        u = since[served] / np.maximum(gap[served], 1)
        return served, self._between(stamps[served], before, after, u), before + u

    def _between(self, stamps, before, after, u):
        p0, p1 = self.positions[before], self.positions[after]
        positions = p0 + u[:, None] * (p1 - p0)
        quaternions = None
        if self.has_orientation:
            quaternions = rotations.slerp(self.quaternions[before],
                                          self.quaternions[after], u)
        return Trajectory(stamps, positions, quaternions)
