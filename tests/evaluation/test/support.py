"""What the tests share; importing it makes the package importable."""

import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

EVALUATION = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TOOL = os.path.join(EVALUATION, "evaluate_trajectory")
sys.path.insert(0, EVALUATION)

# The package can be found only from here on.
from vins_evaluation import rotations  # noqa: E402
from vins_evaluation.sources import LoadedTrajectory  # noqa: E402
from vins_evaluation.trajectory import NANOSECONDS, Trajectory  # noqa: E402

IDENTITY = np.array([0.0, 0.0, 0.0, 1.0])


def shared_data(*parts):
    """Path of a file or folder of the shared data; skips the test without it."""
    beside = os.path.join(EVALUATION, "..", "..", "..", "shared", "data")
    path = os.path.join(os.environ.get("VINS_SHARED_DATA", beside), *parts)
    if not os.path.exists(path):
        raise unittest.SkipTest("no %s in the shared data" % "/".join(parts))
    return path


def about(axis, degrees):
    """Quaternions x y z w of turns about an axis; degrees a number or (N,)."""
    half = np.radians(degrees) / 2.0
    axis = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    return np.concatenate([np.multiply.outer(np.sin(half), axis),
                           np.cos(half)[..., None]], axis=-1)


def matrix(q):
    """Rotation matrix (3, 3) of one quaternion x y z w, by the textbook formula."""
    x, y, z, w = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def trajectory(positions, quaternions=None, period=0.1, begin=1000.0):
    """Poses at a steady rate, identity rotations unless given."""
    positions = np.asarray(positions, dtype=float)
    if quaternions is None:
        quaternions = np.tile(IDENTITY, (len(positions), 1))
    steps = np.arange(len(positions)) * round(period * NANOSECONDS)
    return Trajectory(steps + round(begin * NANOSECONDS), positions, quaternions)


def wandering(count=200, seed=1):
    """A winding path with all rotations, some metres long."""
    rng = np.random.default_rng(seed)
    s = np.linspace(0.0, 6.0, count)
    positions = np.stack([3.0 * np.sin(s), 2.0 * np.cos(1.7 * s), 0.5 * np.sin(2.3 * s)],
                         axis=1)
    turns = rotations.multiply(about([0, 0, 1], 80.0 * np.sin(s)),
                               about(rng.normal(size=3), 40.0 * np.cos(1.3 * s)))
    return trajectory(positions, turns)


def moved(poses, q, translation, scale=1.0):
    """Poses seen from another world frame: p' = scale R(q) p + translation."""
    return Trajectory(poses.stamps, scale * rotations.rotate(q, poses.positions) + translation,
                      rotations.multiply(q, poses.quaternions))


def loaded(poses, source="poses"):
    """Poses as if they came from a file without complaints."""
    return LoadedTrajectory(source, poses, [])


def write_tum(path, poses):
    """Write poses as a TUM file with all nine decimals of the stamps."""
    with open(path, "w", encoding="utf-8") as file:
        file.write("# timestamp tx ty tz qx qy qz qw\n")
        for stamp, p, q in zip(poses.stamps, poses.positions, poses.quaternions):
            seconds = "%d.%09d" % divmod(int(stamp), NANOSECONDS)
            file.write(" ".join([seconds] + ["%.9f" % value for value in [*p, *q]]) + "\n")


def run_tool(*arguments, **options):
    """Run evaluate_trajectory; returns the subprocess.CompletedProcess."""
    environment = dict(os.environ, PYTHONDONTWRITEBYTECODE="1")
    return subprocess.run([options.get("tool", TOOL), *arguments], check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, env=environment,
                          cwd=options.get("cwd"))


class FolderTest(unittest.TestCase):
    """A test case with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        """Path of a file in the folder."""
        return os.path.join(self.folder, name)

    def file(self, name, text):
        """Write a text file; returns its path."""
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)
