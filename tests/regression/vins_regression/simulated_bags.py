"""Bags that simulate_bag makes at test time, once, into the build folder.

A bag's folder is named after what it depends on: the arguments and the simulator's own bytes. It is
made anew when one of them changes, and the old one goes.
"""

import collections
import contextlib
import fcntl
import glob
import hashlib
import os
import shutil
import subprocess
import time

from vins_regression import files

# Paths of what simulate_bag writes.
SimulatedBag = collections.namedtuple("SimulatedBag", "bag rig ground_truth")

# Comes back to its start after 30 s and sees it again for 4 s, in which loops are found.
LOOP = ("loop", ["--trajectory", "hall_loop", "--duration", "34", "--seed", "3"])
# The graver faults of --faults at shorter distances: two gaps in the IMU's samples (50 and 200 ms),
# a second without light, four images left out.
FAULTS = ("faults", ["--trajectory", "hall_loop", "--duration", "25", "--seed", "3", "--imu-gap",
                     "8:0.05", "--imu-gap", "11:0.2", "--blackout", "15:1", "--drop-frames",
                     "20:0.2"])


def simulated(recipe, folder=None):
    """The bag of a recipe, made if it is not there.

    Args:
        recipe: name and arguments of simulate_bag, as LOOP.
        folder: where bags are kept; otherwise in the build folder.
    Returns:
        a SimulatedBag.
    """
    name, arguments = recipe
    folder = folder or os.path.join(files.build_folder(), "simulated_bags")
    os.makedirs(folder, exist_ok=True)
    place = os.path.join(folder, "%s-%s" % (name, _fingerprint(arguments)))
    with _lock(os.path.join(folder, name + ".lock")):
        if not os.path.isdir(place):
            _forget(folder, name)
            _make(name, arguments, place)
    stem = os.path.join(place, name)
    return SimulatedBag(stem + ".bag", stem + "_rig.yaml", stem + "_groundtruth.txt")


def _fingerprint(arguments):
    """Of the arguments, the simulator and the libraries in which it renders."""
    tool = files.program("vins_tests", "simulate_bag")
    libraries = os.path.dirname(os.path.dirname(tool))
    digest = hashlib.sha256("\n".join(arguments).encode())
    for path in [tool] + [os.path.join(libraries, "lib%s.so" % library)
                          for library in ("vins_simulation", "camera_model")]:
        with open(path, "rb") as file:
            digest.update(file.read())
    return digest.hexdigest()[:12]


@contextlib.contextmanager
def _lock(path):
    """Held by one process at a time; it falls with the process."""
    with open(path, "w", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def _forget(folder, name):
    for old in glob.glob(os.path.join(folder, name + "-" + "[0-9a-f]" * 12 + "*")):
        shutil.rmtree(old)


def _make(name, arguments, place):
    """Renders into a folder aside, so that the folder of that name is always whole."""
    aside = place + ".part"
    os.makedirs(aside)
    start = time.monotonic()
    print("simulating %s: %s" % (name, " ".join(arguments)), flush=True)
    subprocess.run([files.program("vins_tests", "simulate_bag"), "-o",
                    os.path.join(aside, name + ".bag")] + arguments,
                   check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    os.rename(aside, place)
    print("simulated %s in %.0f s" % (name, time.monotonic() - start), flush=True)
