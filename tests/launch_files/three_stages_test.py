#!/usr/bin/python3
"""The three stages, started by a launch file with a file in VINS-Mono's form and without input:
each is there and says what it waits for."""

import threading
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

PATIENCE = 60.0  # the vocabulary takes a while to load on a busy machine [s]
STAGES = ['feature tracker', 'estimator', 'pose graph']


class ThreeStages(unittest.TestCase):
    def setUp(self):
        self._lock = threading.Lock()
        self._statuses = {}
        rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics)

    def _on_diagnostics(self, message):
        with self._lock:
            for status in message.status:
                self._statuses[status.name.split(': ')[-1]] = status

    def status(self, stage):
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline and not rospy.is_shutdown():
            with self._lock:
                # An updater's first message only says that it starts.
                if stage in self._statuses and 'tarting' not in self._statuses[stage].message:
                    return self._statuses[stage]
            time.sleep(0.1)
        self.fail('no diagnostics of the %s; there are: %s' % (stage, sorted(self._statuses)))

    def test_each_says_what_it_waits_for(self):
        tracker = self.status('feature tracker')
        self.assertEqual(tracker.level, DiagnosticStatus.WARN, tracker.message)
        self.assertIn('no image yet on /cam0/image_raw', tracker.message)
        estimator = self.status('estimator')
        self.assertEqual(estimator.level, DiagnosticStatus.WARN, estimator.message)
        self.assertIn('no IMU sample yet on /imu0', estimator.message)
        graph = self.status('pose graph')
        self.assertEqual(graph.level, DiagnosticStatus.OK, graph.message)
        self.assertIn('no keyframe yet', graph.message)

    def test_the_tracker_names_its_topics(self):
        values = {value.key: value.value for value in self.status('feature tracker').values}
        self.assertEqual(values['image topic'], '/cam0/image_raw')
        self.assertEqual(values['IMU topic'], '/imu0')

    def test_topics_have_the_names_that_vins_monos_users_know(self):
        for stage in STAGES:
            self.status(stage)
        topics = {name: kind for name, kind in rospy.get_published_topics()}
        for name, kind in [('/feature_tracker/feature_img', 'sensor_msgs/Image'),
                           ('/vins_estimator/odometry', 'nav_msgs/Odometry'),
                           ('/vins_estimator/imu_propagate', 'nav_msgs/Odometry'),
                           ('/vins_estimator/path', 'nav_msgs/Path'),
                           ('/vins_estimator/point_cloud', 'sensor_msgs/PointCloud2'),
                           ('/vins_estimator/camera_pose_visual',
                            'visualization_msgs/MarkerArray'),
                           ('/pose_graph/pose_graph_path', 'nav_msgs/Path'),
                           ('/pose_graph/match_image', 'sensor_msgs/Image')]:
            self.assertEqual(topics.get(name), kind, name)


if __name__ == '__main__':
    rospy.init_node('three_stages_test')
    rostest.rosrun('vins_tests', 'three_stages_test', ThreeStages)
