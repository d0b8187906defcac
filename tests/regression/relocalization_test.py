#!/usr/bin/python3
"""A map that one run saves by its service, and another run finds itself in: relocalize.launch."""

import os

import rospy
from nav_msgs.msg import Path
from vins_msgs.srv import MapFile

from vins_regression import judgement, processes, simulated_bags, topics
from vins_regression.live_case import FRAME_NS, LiveCase, run

SECOND = 10**9
START = 1600000000 * SECOND  # of simulated bags
MAPPED = 15   # seconds of the flight, from its start on
SECOND_RUN = 20  # where the other run begins: somewhere else, on its way back
AT_START_AGAIN = 30  # from here on it sees what the first run has seen
END = 34


class RelocalizationTest(LiveCase):
    """Two runs over topics, each with nodes of its own; the file is all that they share."""

    def test_a_saved_map_is_found_again(self):
        bag = simulated_bags.simulated(simulated_bags.LOOP)
        map_file = os.path.join(self.folder, "a new folder", "hall.map")
        self._fly_and_save(bag, map_file)
        self._fly_in(bag, map_file)

    def _fly_and_save(self, bag, map_file):
        listener = self.listen()
        nodes = self.start_nodes(bag.rig)
        self.wait_for_end_of(self.play(bag.bag, "--duration", str(MAPPED)), 60.0)
        self.wait_for_odometry(listener, START + MAPPED * SECOND - 4 * FRAME_NS, 5.0)
        answer = rospy.ServiceProxy("/pose_graph/save_map", MapFile)(map_file)
        self.assertTrue(answer.success, answer.message)
        self.assertIn("saved " + map_file, answer.message)
        self.assertTrue(os.path.isfile(map_file))
        for node in nodes.values():
            self.assert_ends(node, within=10.0)  # how soon is clean_end_test's matter
        listener.close()

    def _fly_in(self, bag, map_file):
        listener, paths = self.listen(), []
        ear = rospy.Subscriber("/pose_graph/pose_graph_path", Path, paths.append, queue_size=10)
        self.addCleanup(ear.unregister)
        launched = self.started(processes.launch("relocalize.launch", map=map_file, config=bag.rig,
                                                 bag=bag.bag, start=str(SECOND_RUN)))
        self.wait_for_odometry(listener, START + END * SECOND - 2 * FRAME_NS, 60.0)
        listener.wait_for(lambda: listener.corrected[-1].stamp == listener.odometry[-1].stamp, 3.0)
        self.assertIn("loaded " + map_file, launched.output())
        joined = self._judge_join(listener)
        self._judge_joined_path(topics.poses_of(paths[-1]), bag)
        self._judge_live_path(topics.poses_of(paths[0]), listener, joined, bag)
        self.assert_ends(launched, within=10.0)

    def _judge_join(self, listener):
        """Stamp of the loop that has joined the run to the map."""
        told = [event.stamp for event in listener.events if event.code == "sequence_joined"]
        self.assertEqual(len(told), 1, listener.codes())
        after = judgement.seconds(told[0], START)
        print("initialised at %.1f s, in the map at %.1f s of the flight"
              % (judgement.time_of(listener.odometry[0], START), after), flush=True)
        # Seconds with the map in view; before them there is nothing to be recognised.
        self.assertGreater(after, AT_START_AGAIN)
        self.assertLess(after, min(AT_START_AGAIN + 5.0, END))
        old = [loop.old_id for loop in listener.loops]
        self.assertLess(min(old), 0, "keyframes of a loaded map have negative numbers")
        return told[0]

    def _judge_joined_path(self, poses, bag):
        """Both runs as the map's path has them in the end, as one."""
        times = [judgement.time_of(pose, START) for pose in poses]
        self.assertLess(times[0], 5.0, "the map's first keyframe")
        self.assertGreater(times[-1], END - 2.0, "the run's last keyframe")
        self.assertGreater(sum(time > SECOND_RUN for time in times), 10, "keyframes of this run")
        error = judgement.position_error(bag.ground_truth, poses)
        print("joined path: %d keyframes, position error %.3f m" % (len(poses), error), flush=True)
        # run_bag has 0.014 m. Not joined, the two would lie metres apart: each run's world begins
        # where that run was initialised, and these places are 6 m from each other.
        self.assertLess(error, 0.1)

    def _judge_live_path(self, stored, listener, joined, bag):
        """The map as it was loaded, and what the run says of itself once it is in it."""
        self.assertLess(judgement.time_of(stored[-1], START), MAPPED + 0.1, "the map alone")
        live = [pose for pose in listener.corrected if pose.stamp > joined + SECOND // 2]
        self.assertGreater(len(live), 10, "poses half a second after the join")
        error = judgement.position_error(bag.ground_truth, stored + live)
        print("live in the map: position error %.3f m" % error, flush=True)
        self.assertLess(error, 0.1)


if __name__ == "__main__":
    run("relocalization_test", RelocalizationTest)
