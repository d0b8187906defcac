"""Figures of a walk whose truth and estimate are made up."""

import os
import shutil
import tempfile
import unittest

import numpy as np
from support import IDENTITY

from vins_evaluation import walk_figures
from vins_evaluation.trajectory import NANOSECONDS, Trajectory

RIG = """%YAML:1.0
---
extrinsicTranslation: !!opencv-matrix
   rows: 1
   cols: 3
   dt: d
   data: [0, 0, 0]
td: 0.040
rolling_shutter: 1
rolling_shutter_tr: 0.020
"""
HEADER = ("#stamp [ns],sequence,landmarks,outliers,keyframe,sigma_px [m],sigma_py [m],sigma_pz [m],"
          "sigma_yaw [deg],sigma_tilt [deg],sigma_vx [m/s],sigma_vy [m/s],sigma_vz [m/s],td [s],"
          "sigma_td [s]\n")


def square_walk(rest=2.0, speed=0.5, duration=30.0, step=0.005):
    """At rest, then round a circle of 1 m at a constant speed."""
    seconds = np.arange(0.0, duration, step)
    angle = speed * np.clip(seconds - rest, 0.0, None)
    positions = np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    quaternions = np.tile(IDENTITY, (len(seconds), 1))
    stamps = np.round(seconds * NANOSECONDS).astype(np.int64) + 1600000000 * NANOSECONDS
    return Trajectory(stamps, positions, quaternions)


class SufficientMotionTest(unittest.TestCase):
    def test_begins_when_the_last_seconds_path_is_long_enough(self):
        # 0.1 m at 0.5 m/s take 0.2 s.
        self.assertAlmostEqual(walk_figures.sufficient_motion(square_walk()), 2.2, delta=0.02)

    def test_never_at_rest(self):
        self.assertIsNone(walk_figures.sufficient_motion(square_walk(rest=100.0)))


class ConsistencyTest(unittest.TestCase):
    def nees(self, error_share, sequence=None):
        truth = square_walk(step=0.05)
        count = len(truth)
        random = np.random.default_rng(1)
        errors = error_share * 0.02 * random.standard_normal((count, 3))
        errors[0] = 0.0
        if sequence is not None:
            errors[np.flatnonzero(np.diff(sequence)) + 1] = 0.0
        estimate = Trajectory(truth.stamps, truth.positions + errors, truth.quaternions)
        table = {name: np.full(count, 0.02) for name in
                 ("sigma_px", "sigma_py", "sigma_pz", "sigma_yaw", "sigma_tilt")}
        table["sequence"] = np.zeros(count) if sequence is None else sequence
        return walk_figures.consistency(truth, estimate, table)

    def test_errors_as_large_as_their_deviations_have_a_nees_of_one(self):
        position, rotation = self.nees(1.0)
        self.assertAlmostEqual(position, 1.0, delta=0.15)
        self.assertAlmostEqual(rotation, 0.0)

    def test_errors_of_twice_the_deviation_have_four(self):
        self.assertAlmostEqual(self.nees(2.0)[0], 4.0, delta=0.6)

    def test_each_part_between_resets_begins_anew(self):
        truth = square_walk(step=0.05)
        sequence = (np.arange(len(truth)) >= 300).astype(float)
        self.assertAlmostEqual(self.nees(1.0, sequence)[0], 1.0, delta=0.15)

    def test_one_pose_tells_nothing(self):
        truth = square_walk().selected([0])
        table = {name: np.full(1, 0.02) for name in
                 ("sigma_px", "sigma_py", "sigma_pz", "sigma_yaw", "sigma_tilt", "sequence")}
        self.assertEqual(walk_figures.consistency(truth, truth, table), (None, None))


class ReadWalkTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.rig = self.write("true_rig.yaml", RIG)
        self.truth = square_walk()
        self.write("ground_truth.txt", self.lines(self.truth))

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    @staticmethod
    def lines(trajectory):
        return "".join("%d.%09d %r %r %r 0 0 0 1\n" % (s // NANOSECONDS, s % NANOSECONDS, *p)
                       for s, p in zip(trajectory.stamps.tolist(), trajectory.positions.tolist()))

    def run_with(self, first, sequence_at, td):
        """A run whose stamps are half of the read-out early, as without knowing it."""
        which = np.arange(first, len(self.truth), 10)
        poses = self.truth.selected(which).shifted(-10000000)
        self.write("vio_live.txt", self.lines(poses))
        self.write("estimator.csv", HEADER + "".join(
            "%d,%d,50,0,0%s,%f,0.001\n" % (s, i >= sequence_at, 8 * ",0.1", td)
            for i, s in enumerate(poses.stamps)))
        return walk_figures.read_walk(self.folder, self.rig)

    def test_a_perfect_run(self):
        figures = self.run_with(first=600, sequence_at=10**6, td=0.053)
        self.assertAlmostEqual(figures.motion_s, 2.2, delta=0.02)
        self.assertAlmostEqual(figures.first_pose_s, 0.8, delta=0.02)
        self.assertEqual(figures.resets, 0)
        self.assertAlmostEqual(figures.coverage, 97.1, delta=0.3)
        self.assertLess(figures.ate_percent, 0.01)
        self.assertAlmostEqual(figures.path_m, 13.5, delta=0.1)
        # The middle row is taken 40 + 10 ms late.
        self.assertAlmostEqual(figures.td_error_s, 0.003, places=6)

    def test_with_a_known_readout_poses_are_of_the_first_row(self):
        known = walk_figures.read_truth(self.rig, readout_is_known=True)
        unknown = walk_figures.read_truth(self.rig)
        self.assertEqual(known, (0.04, 0.0))
        self.assertEqual(unknown, (0.05, 0.01))

    def test_resets_are_counted(self):
        self.assertEqual(self.run_with(first=600, sequence_at=100, td=0.0).resets, 1)

    def test_one_pose_after_the_end_of_the_truth_has_no_accuracy(self):
        figures = self.run_with(first=len(self.truth) - 1, sequence_at=10**6, td=0.0)
        self.assertIsNone(figures.ate_percent)
        self.assertIsNone(figures.nees_position)

    def test_a_run_that_never_started(self):
        self.write("estimator.csv", HEADER)
        figures = walk_figures.read_walk(self.folder, self.rig)
        self.assertIsNone(figures.first_pose_s)
        self.assertEqual(figures.coverage, 0.0)
        table = walk_figures.text_table({"1": figures})
        self.assertIn("first pose", table)
        self.assertIn("started at all: 0 of 1", walk_figures.summary({"1": figures}))


if __name__ == "__main__":
    unittest.main()
