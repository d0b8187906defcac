"""A test case with the three nodes, a player and a listener."""

import os
import shutil
import unittest

import rospy

from vins_regression import files, processes
from vins_regression.listener import Listener

FRAME_NS = 50000000  # of cameras at 20 Hz


class LiveCase(unittest.TestCase):
    """Starts what a test asks for, and ends all of it after the test."""

    def setUp(self):
        self.processes = []
        self.folder = files.work_folder()
        self.addCleanup(self._end)

    def _end(self):
        for process in self.processes:
            process.kill()
        shutil.rmtree(self.folder, ignore_errors=True)

    def started(self, process):
        """Takes a Process into the case's care."""
        self.processes.append(process)
        return process

    def start_nodes(self, rig, **more):
        """Starts the three nodes.

        Args:
            rig: path of the configuration file.
            more: arguments of single nodes, as pose_graph=["_save_map:=FILE"].
        Returns:
            {name: Process}.
        """
        return {name: self.started(processes.start_node(name, rig, *more.get(name, [])))
                for name in processes.NODES}

    def play(self, bag, *options):
        """A player, once the three nodes are there."""
        self.wait_for_nodes()
        return self.started(processes.play(bag, *options))

    def wait_for_nodes(self):
        """Until the nodes have subscribed each other's topics; fails after 20 s."""
        ears = ["/imu0", "/cam0/image_raw", "/feature_tracker/feature", "/vins_estimator/keyframe",
                "/vins_estimator/odometry", "/pose_graph/loop_match"]
        for _ in range(200):
            if self._subscribed(ears):
                return
            rospy.sleep(0.1)
        self.fail("the nodes are not there after 20 s:\n" + self.said())

    @staticmethod
    def _subscribed(names):
        _, _, (_, subscriptions, _) = rospy.get_master().getSystemState()
        by = dict(subscriptions)
        here = rospy.get_name()
        return all(set(by.get(name, [])) - {here} for name in names)

    def wait_for_end_of(self, player, timeout):
        """Until the player has ended by itself."""
        self.assertIsNotNone(player.wait(timeout), "the bag did not end")
        self.assertEqual(player.exit_code, 0, player.output())

    def wait_for_odometry(self, listener, stamp, timeout):
        """Until the odometry has come to a stamp (nanoseconds)."""
        came = listener.wait_for(
            lambda: listener.odometry and listener.odometry[-1].stamp >= stamp, timeout)
        self.assertTrue(came, "no odometry at %.3f s:\n%s" % (1e-9 * stamp, self.said()))

    def assert_ends(self, process, within=2.0, code=0):
        """Ctrl-C ends the process within seconds, with an exit code."""
        took = process.interrupt(10.0)
        self.assertIsNotNone(took, "%s still runs 10 s after Ctrl-C" % process.name)
        self.assertLess(took, within, process.name)
        self.assertEqual(process.exit_code, code, process.output())

    def said(self):
        """What the processes have said, for a failure's message."""
        return "\n".join("--- %s (%s)\n%s" % (process.name, process.exit_code, process.output())
                         for process in self.processes)

    def listen(self):
        """A Listener that ends with the test."""
        listener = Listener()
        self.addCleanup(listener.close)
        return listener


def run(name, case):
    """Runs a rostest's case and ends the program as rostest expects it."""
    import rostest  # only here: it takes over the command line
    rospy.init_node(name, disable_signals=True)
    rostest.rosrun("vins_tests", name, case)


def exists(path):
    """Whether a file is there and not empty."""
    return os.path.isfile(path) and os.path.getsize(path) > 0
