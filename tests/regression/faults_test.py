#!/usr/bin/python3
"""A flight with gaps in the IMU's samples, a second without light, and images left out."""

import numpy as np

from vins_regression import judgement, simulated_bags
from vins_regression.live_case import FRAME_NS, LiveCase, run

SECOND = 10**9
START = 1600000000 * SECOND  # of simulated bags
END = START + 25 * SECOND


class FaultsTest(LiveCase):
    """The nodes tell of each fault, and fly on."""

    def test_faults_are_told_and_survived(self):
        bag = simulated_bags.simulated(simulated_bags.FAULTS)
        listener = self.listen()
        self.start_nodes(bag.rig)
        player = self.play(bag.bag)
        self.wait_for_odometry(listener, END - 2 * FRAME_NS, 60.0)
        self.wait_for_end_of(player, 20.0)
        self._judge_events(listener)
        self._judge_path(listener, bag)

    def _judge_events(self, listener):
        told = {}
        for event in listener.events:
            told.setdefault(event.code, []).append((event.stamp - START) / SECOND)
        print({code: times for code, times in told.items() if code != "loop_found"}, flush=True)
        self.assertEqual(len(told.get("initialized", [])), 1, told)
        self.assertTrue(self._near(told.get("imu_gap", []), 8.0), told)
        self.assertTrue(self._near(told.get("imu_gap", []), 11.0), told)
        self.assertTrue(self._near(told.get("tracking_lost", []), 15.0), told)
        self.assertTrue(self._near(told.get("tracking_resumed", []), 16.0), told)
        self.assertNotIn("reset", told)

    @staticmethod
    def _near(times, second):
        return any(second - 0.1 <= time <= second + 1.5 for time in times)

    def _judge_path(self, listener, bag):
        stamps = np.array([pose.stamp for pose in listener.odometry])
        # The four images that were left out are the longest pause but one frame.
        self.assertLessEqual(np.diff(stamps).max(), 6 * FRAME_NS)
        result = judgement.evaluated(bag.ground_truth, listener.odometry)
        print("position error %.3f m" % result.statistics("position").rmse, flush=True)
        # A second on the IMU alone drifts by some centimetres at this IMU's bias; a state that had
        # been lost there would be metres off.
        self.assertLess(result.statistics("position").rmse, 0.15)
        self.assertLess(abs(result.scale_error), 1.5, "[%]")


if __name__ == "__main__":
    run("faults_test", FaultsTest)
