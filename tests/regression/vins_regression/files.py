"""Where things lie: the workspace, its programs, real recordings."""

import os
import sys
import tempfile
import unittest

import roslib.packages
import rospkg

_HERE = os.path.dirname(os.path.realpath(__file__))
WORKSPACE = os.path.realpath(os.path.join(_HERE, "..", "..", ".."))

# The figures are those that evaluate_trajectory gives; it lies beside the regressions.
sys.path.insert(0, os.path.join(WORKSPACE, "tests", "evaluation"))


def program(package, name):
    """Path of a node or tool of a built workspace.

    Raises:
        FileNotFoundError saying what to do.
    """
    try:
        found = roslib.packages.find_node(package, name)
    except rospkg.ResourceNotFound:
        found = []
    found = [path for path in found if not path.startswith(os.path.join(WORKSPACE, "tests"))]
    if not found:
        raise FileNotFoundError("no program %s of package %s: build the workspace and source its "
                                "build/devel/setup.bash" % (name, package))
    return found[0]


def build_folder():
    """The folder that the workspace is built in: of build/devel/lib/PACKAGE/PROGRAM."""
    tool = os.path.realpath(program("vins_tests", "simulate_bag"))
    return os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(tool))))


def real_recording(name):
    """Folder of a real recording; the running test is skipped, and says so, without it."""
    beside = os.path.join(WORKSPACE, "..", "shared", "data")
    path = os.path.join(os.environ.get("VINS_SHARED_DATA", beside), name)
    if not os.path.exists(path):
        message = "skipped: no real recording %s (set VINS_SHARED_DATA)" % name
        print(message, flush=True)
        raise unittest.SkipTest(message)
    return os.path.realpath(path)


def work_folder():
    """A new folder for files of this run; the caller removes it."""
    return tempfile.mkdtemp(prefix="vins_regression_")
