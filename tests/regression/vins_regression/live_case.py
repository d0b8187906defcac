"""A test case with the three nodes, a player and a listener."""

import rospy

from vins_regression import processes
from vins_regression.listener import Listener
from vins_regression.processes_case import ProcessCase

FRAME_NS = 50000000  # of cameras at 20 Hz


class LiveCase(ProcessCase):
    """Starts the live system as a test asks for it."""

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

    def play(self, bag, *options, loops=True):
        """A player, once the three nodes are there; loops: whether loop closing is on."""
        self.wait_for_nodes(loops)
        return self.started(processes.play(bag, *options))

    def wait_for_nodes(self, loops=True):
        """Until the nodes have subscribed each other's topics; fails after 20 s."""
        ears = ["/imu0", "/cam0/image_raw", "/feature_tracker/feature", "/vins_estimator/odometry",
                "/pose_graph/loop_match"]
        if loops:
            ears.append("/vins_estimator/keyframe")
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

    def listen(self):
        """A Listener that ends with the test."""
        listener = Listener()
        self.addCleanup(listener.close)
        return listener


def run(name, case):
    """Runs the case of a rostest and ends the program as rostest expects it."""
    import rostest  # only here: it takes over the command line
    rospy.init_node(name, disable_signals=True)
    rostest.rosrun("vins_tests", name, case)
