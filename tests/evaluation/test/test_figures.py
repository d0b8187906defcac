"""draw_figures, run as a user runs it, and what it reads."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import support
from PIL import Image
from vins_evaluation import run_figures
from vins_evaluation.errors import EvaluationError
from vins_evaluation.run_folder import RunFolder

TOOL = os.path.join(support.EVALUATION, "draw_figures")
BEGIN = 1600000000000000000
STEP = 50000000
FRAMES = 100


def pose_lines(offset):
    """A straight path with 1 m/s along x in TUM's form, moved by an offset along y."""
    return "".join("%d.%09d %.6f %.6f 0 0 0 0 1\n" % (*divmod(BEGIN + STEP * i, 10**9), 0.05 * i,
                                                       offset * i) for i in range(FRAMES))


class FiguresTest(unittest.TestCase):
    """On a run that is made up, of which all is known."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.run_folder = os.path.join(self._folder.name, "run")
        self.places = os.path.join(self._folder.name, "places")
        self.out = os.path.join(self._folder.name, "new", "out")
        os.mkdir(self.run_folder)
        os.mkdir(self.places)
        self._write_run()
        self._write("places", "tree_curve.csv",
                    "normalized_score,answers,right,precision,recall\n1,1,1,1,0.1\n0.5,4,3,0.75,0.4\n")
        for number in (2, 10, 11):
            self._write_picture("places", "loop_%d_1.png" % number, 10 * number)

    def test_draws_all(self):
        done = self._draw()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(sorted(os.listdir(self.out)),
                         ["errors.png", "loops.png", "match.jpg", "places.png", "stage_times.png",
                          "start.png", "tracks.jpg", "tracks_over_time.png"])
        for name in os.listdir(self.out):
            self.assertLess(os.path.getsize(os.path.join(self.out, name)), 60001, name)
        # The loop in the middle; sorted as text it would be another.
        picture = Image.open(os.path.join(self.out, "match.jpg"))
        self.assertAlmostEqual(float(np.mean(np.asarray(picture))), 100.0, delta=3.0)

    def test_tells_what_is_missing(self):
        for folder, name in (("run", "tracker.csv"), ("run", "tracks.png"),
                             ("places", "tree_curve.csv")):
            os.rename(os.path.join(self._folder.name, folder, name),
                      os.path.join(self._folder.name, "away"))
            done = self._draw()
            self.assertEqual(done.returncode, 1, name)
            self.assertIn("draw_figures: ", done.stderr)
            self.assertIn(os.path.join(self._folder.name, folder), done.stderr)
            os.rename(os.path.join(self._folder.name, "away"),
                      os.path.join(self._folder.name, folder, name))
        self.assertEqual(subprocess.run([sys.executable, TOOL], capture_output=True,
                                        check=False).returncode, 1)

    def test_bad_tables_are_refused_by_name(self):
        for text in ("", "#stamp [ns],before\n", "#stamp [ns],before\n1,many\n",
                     "#stamp [ns],before\n1\n"):
            self._write("run", "tracker.csv", text)
            with self.assertRaisesRegex(EvaluationError, "tracker.csv"):
                RunFolder(self.run_folder).table("tracker")

    def test_files_of_two_runs_are_refused(self):
        self._write("run", "vio_live.txt", "".join(pose_lines(0.0).splitlines(True)[1:]))
        with self.assertRaisesRegex(EvaluationError, "another run"):
            run_figures.errors(RunFolder(self.run_folder))

    def test_errors_begin_at_nothing_and_grow(self):
        figure = run_figures.errors(RunFolder(self.run_folder))
        # The odometry leaves the path to the left by a hundredth of the way.
        error = figure.axes[1].lines[0].get_ydata()
        self.assertEqual(error[0], 0.0)
        self.assertAlmostEqual(error[-1], 100.0 * 0.0005 * (FRAMES - 1), places=3)

    def test_loops_join_the_places_that_events_name(self):
        figure = run_figures.loops(RunFolder(self.run_folder))
        ((later, earlier),) = figure.axes[0].collections[0].get_segments()
        self.assertAlmostEqual(later[0] - earlier[0], 2.0, places=2)

    def _draw(self):
        return subprocess.run([sys.executable, TOOL, self.run_folder, self.run_folder, self.places,
                               self.out], capture_output=True, text=True, check=False)

    def _write_run(self):
        stamps = [BEGIN + STEP * i for i in range(FRAMES)]
        self._write("run", "tracker.csv",
                    "#stamp [ns],before,tracked,inliers,detected,mean_track_length\n"
                    + "".join("%d,100,95,90,10,%d\n" % (s, i) for i, s in enumerate(stamps)))
        names = ["sigma_p%s [m]" % axis for axis in "xyz"] + ["sigma_yaw [deg]", "sigma_tilt [deg]"]
        names += ["sigma_v%s [m/s]" % axis for axis in "xyz"]
        self._write("run", "estimator.csv",
                    "#stamp [ns],sequence,landmarks,outliers,keyframe," + ",".join(names) + "\n"
                    + "".join("%d,0,50,0,1%s\n" % (s, 8 * ",0.1") for s in stamps))
        self._write("run", "ground_truth.txt", pose_lines(0.0))
        for name in ("vio_live", "loop_live", "loop_final"):
            self._write("run", name + ".txt", pose_lines(0.0005))
        self._write("run", "vins_result_no_loop.csv",
                    "".join("%d,0,0,0,1,0,0,0,1,0,0,\n" % s for s in stamps))
        self._write("run", "events.csv",
                    "#stamp [ns],severity,code,text,figures\n"
                    "%d,info,init_few_tracks,\"waiting: a, b\",shared_features=3\n"
                    "%d,info,loop_found,\"a place\",old=1 seconds_ago=2\n" % (BEGIN, stamps[60]))
        stage = {"count": 3, "mean_ms": 2.0, "p95_ms": 3.0}
        self._write("run", "timing.json", json.dumps({"stages": {"tracker": stage}}))
        self._write_picture("run", "tracks.png", 50)

    def _write(self, folder, name, text):
        with open(os.path.join(self._folder.name, folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    def _write_picture(self, folder, name, grey):
        Image.new("L", (1500, 400), grey).save(os.path.join(self._folder.name, folder, name))


if __name__ == "__main__":
    unittest.main()
