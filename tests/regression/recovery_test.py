#!/usr/bin/python3
"""What may go wrong on the way: a node that dies, a bag that starts again, no light, no IMU."""

import numpy as np

from vins_regression import judgement, simulated_bags
from vins_regression.live_case import FRAME_NS, LiveCase, run
from vins_regression.processes import start_node

SECOND = 10**9
START = 1600000000 * SECOND  # of simulated bags


def after(poses, seconds, until=1e9):
    """Of poses, those between two times from the bag's start."""
    return [pose for pose in poses if seconds <= judgement.time_of(pose, START) <= until]


class RecoveryTest(LiveCase):
    """The rest goes on, and what was lost comes back."""

    def test_each_node_is_killed_and_restarted(self):
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        listener = self.listen()
        nodes = self.start_nodes(bag.rig)
        player = self.play(bag.bag)
        for second, name in ((8, "feature_tracker"), (14, "pose_graph"), (20, "vins_estimator")):
            self.wait_for_odometry(listener, START + second * SECOND, 30.0)
            nodes[name].kill()
            nodes[name] = self.started(start_node(name, bag.rig))
        self.wait_for_end_of(player, 60.0)
        for name, node in nodes.items():
            self.assertTrue(node.is_running(), "%s has ended:\n%s" % (name, node.output()))
        self._judge_pauses(listener)
        self._judge_continued(listener, bag)
        self._judge_begun_anew(listener, bag)

    def _judge_pauses(self, listener):
        """A node needs a second to start; the estimator initialises on the way besides, which
        takes as long as at the bag's start at most: three seconds, and three more to be sure."""
        stamps = np.array([pose.stamp - START for pose in listener.odometry]) / SECOND
        gaps = {round(stamps[i]): stamps[i + 1] - stamps[i]
                for i in np.flatnonzero(np.diff(stamps) > 0.25)}
        self.assertLess(max([gap for second, gap in gaps.items() if second < 19], default=0.0), 3.0,
                        "pauses of the odometry, by the second: %s" % gaps)
        self.assertLess(max(gaps.values()), 8.0, gaps)
        self.assertGreater(stamps[-1], 33.5, "goes on to the end")

    def _judge_continued(self, listener, bag):
        """Without features for a second the IMU carries the pose: the odometry stays one."""
        before = [pose for pose in listener.odometry if judgement.time_of(pose, START) < 19.9]
        # A second on the IMU alone may cost some centimetres more than the 0.1 m of a whole flight.
        self.assertLess(judgement.position_error(bag.ground_truth, before, max_gap=5.0), 0.2)
        new_graph = [pose.stamp for pose in after(listener.corrected, 16.0, 19.9)]
        self.assertLess(max(np.diff(new_graph)), 5 * FRAME_NS, "the new pose graph's odometry")

    def _judge_begun_anew(self, listener, bag):
        """The new estimator has a world of its own, and the pose graph takes it on."""
        self.assertEqual(listener.codes().count("initialized"), 2, listener.codes())
        self.assertLess(judgement.position_error(bag.ground_truth, after(listener.odometry, 21.0)),
                        0.1)
        self.assertGreater(len(after(listener.corrected, 30.0)), 70, "of 80 frames")
        graph = listener.diagnostics["pose_graph: pose graph"]
        self.assertEqual(graph["sequences"], "2", graph)

    def test_a_bag_begins_again(self):
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        listener = self.listen()
        nodes = self.start_nodes(bag.rig)
        self.wait_for_end_of(self.play(bag.bag, "--duration", "10"), 40.0)
        first = len(listener.odometry)
        self.wait_for_end_of(self.play(bag.bag, "--duration", "10"), 40.0)
        self.wait_for_odometry(listener, START + 10 * SECOND - 4 * FRAME_NS, 3.0)
        for name, node in nodes.items():
            self.assertTrue(node.is_running(), "%s has ended:\n%s" % (name, node.output()))
        again = listener.odometry[first:]
        self.assertEqual(listener.codes().count("initialized"), 2, listener.codes())
        self.assertLess(judgement.time_of(again[0], START), 6.0)
        self.assertLess(judgement.position_error(bag.ground_truth, again), 0.1)
        # The map is kept, and the second run finds itself in the first one's.
        self.assertIn("sequence_joined", listener.codes())
        self._judge_one_map(listener, bag)

    def _judge_one_map(self, listener, bag):
        """The first run up to its ninth second and the second run from there on are one flight."""
        stamps = [pose.stamp for pose in listener.corrected]
        again = int(np.argmin(np.diff(stamps))) + 1
        first = [pose for pose in listener.corrected[:again]
                 if judgement.time_of(pose, START) < 9.0]
        second = after(listener.corrected[again:], 9.0)
        self.assertGreater(min(len(first), len(second)), 10)
        # Two maps that had nothing to do with each other would lie metres apart: each run's world
        # begins where that run was initialised. 0.2 m is an odometry's error and a loop's.
        self.assertLess(judgement.position_error(bag.ground_truth, first + second), 0.2)


if __name__ == "__main__":
    run("recovery_test", RecoveryTest)
