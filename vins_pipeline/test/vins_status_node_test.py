#!/usr/bin/python3
"""vins_status --once beside stages that are played: its exit code and what it says."""

import os
import subprocess
import sys
import threading
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Image, Imu
from std_msgs.msg import Header

TOOL = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'tools', 'vins_status')


class PlayedStages:
    """Publishes what healthy stages do: 20 images and odometries a second, diagnostics."""

    def __init__(self):
        self.estimator_level = DiagnosticStatus.OK
        self.plays_odometry = True
        self._images = rospy.Publisher('/cam7/image', Image, queue_size=10)
        self._imu = rospy.Publisher('/imu7', Imu, queue_size=10)
        self._features = rospy.Publisher('/feature_tracker/feature', Header, queue_size=10)
        self._odometry = rospy.Publisher('/vins_estimator/odometry', Odometry, queue_size=10)
        self._propagated = rospy.Publisher('/vins_estimator/imu_propagate', Odometry, queue_size=10)
        self._diagnostics = rospy.Publisher('/diagnostics', DiagnosticArray, queue_size=10)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._play)
        self._thread.start()

    def stop(self):
        self._stop.set()
        self._thread.join()

    def _play(self):
        count = 0
        while not self._stop.wait(0.05):
            header = Header(stamp=rospy.Time(1600000000, 50000000 * (count % 20)))
            header.stamp.secs += count // 20
            self._images.publish(Image(header=header))
            self._imu.publish(Imu(header=header))
            self._features.publish(header)
            self._propagated.publish(Odometry(header=header))
            if self.plays_odometry:
                self._odometry.publish(Odometry(header=header))
            if count % 10 == 0:
                self._diagnostics.publish(self._statuses())
            count += 1

    def _statuses(self):
        topics = [KeyValue('image topic', '/cam7/image'), KeyValue('IMU topic', '/imu7')]
        estimator = 'tracking' if self.estimator_level == DiagnosticStatus.OK else 'move sideways'
        return DiagnosticArray(status=[
            DiagnosticStatus(name='feature_tracker: feature tracker', message='tracking',
                             values=topics),
            DiagnosticStatus(name='vins_estimator: estimator', level=self.estimator_level,
                             message=estimator),
            DiagnosticStatus(name='pose_graph: pose graph', message='mapping')])


def run_tool(*arguments, **environment):
    return subprocess.run([sys.executable, TOOL, '--once'] + list(arguments), timeout=60,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding='utf-8',
                          env=dict(os.environ, **environment))


class VinsStatus(unittest.TestCase):
    def setUp(self):
        self.stages = PlayedStages()

    def tearDown(self):
        self.stages.stop()

    def test_all_is_well(self):
        result = run_tool('--timeout', '15')
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        for shown in ['all is well', '/cam7/image', '/imu7', 'image to odometry', 'mapping']:
            self.assertIn(shown, result.stdout)

    def test_a_stage_that_warns(self):
        self.stages.estimator_level = DiagnosticStatus.WARN
        result = run_tool('--timeout', '8')
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn('estimator: move sideways', result.stdout)

    def test_an_estimator_that_hands_out_nothing(self):
        self.stages.plays_odometry = False
        result = run_tool('--timeout', '8')
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn('/vins_estimator/odometry: nothing comes', result.stdout)

    def test_no_stage_at_all(self):
        self.stages.stop()
        start = time.monotonic()
        result = run_tool('--timeout', '2')
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn('estimator: no diagnostics: does the node run?', result.stdout)
        # The wait, and a Python with ROS starting and ending on a busy machine.
        self.assertLess(time.monotonic() - start, 30.0)

    def test_no_master(self):
        result = run_tool(ROS_MASTER_URI='http://localhost:9')
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertIn('no ROS master at http://localhost:9', result.stderr)


if __name__ == '__main__':
    rospy.init_node('vins_status_node_test')
    rostest.rosrun('vins_pipeline', 'vins_status_node_test', VinsStatus)
