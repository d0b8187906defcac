#!/usr/bin/python3
"""Two rigs beside each other, in two namespaces, one of them as nodelets: each hears its own sensors
and stages, and none of the other's."""

import threading
import time
import unittest

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu
from tf2_msgs.msg import TFMessage

PATIENCE = 90.0  # two vocabularies take a while to load on a busy machine [s]
RIGS = ['left', 'right']
# By topic: the stage that publishes it, and those that subscribe it.
TOPICS = {
    'feature_tracker/feature': ('feature_tracker', ['vins_estimator']),
    'feature_tracker/restart': ('feature_tracker', ['vins_estimator']),
    'vins_estimator/odometry': ('vins_estimator', ['pose_graph']),
    'vins_estimator/keyframe': ('vins_estimator', ['pose_graph']),
    'vins_estimator/keyframe_pose_update': ('vins_estimator', ['pose_graph']),
    'vins_estimator/loop_edge': ('vins_estimator', ['pose_graph']),
    'pose_graph/loop_match': ('pose_graph', ['vins_estimator']),
}


class TwoRigs(unittest.TestCase):
    def setUp(self):
        self._lock = threading.Lock()
        self._odometry = {rig: [] for rig in RIGS}
        self._transforms = set()
        self._statuses = {}
        for rig in RIGS:
            rospy.Subscriber('/%s/pose_graph/odometry' % rig, Odometry, self._on_odometry, rig)
        rospy.Subscriber('/tf', TFMessage, self._on_tf)
        rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics)

    def _on_odometry(self, message, rig):
        with self._lock:
            self._odometry[rig].append(message)

    def _on_tf(self, message):
        with self._lock:
            self._transforms |= {(item.header.frame_id, item.child_frame_id)
                                 for item in message.transforms}

    def _on_diagnostics(self, message):
        with self._lock:
            self._statuses.update({status.name: status.message for status in message.status})

    def wait_for(self, condition, what):
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline and not rospy.is_shutdown():
            with self._lock:
                if condition():
                    return
            time.sleep(0.1)
        self.fail('no ' + what)

    @staticmethod
    def _stages(rig, table, topic):
        """Nodes of a topic; the stages of nodelets are in one node."""
        return set(dict(table).get('/%s/%s' % (rig, topic), []))

    def _names(self, rig, stages):
        return {'/%s/%s' % (rig, 'vins_manager' if rig == 'right' else stage)
                for stage in stages}

    def _wired(self, topic, publisher, subscribers):
        published, subscribed, _ = rosgraph.Master('/two_rigs_test').getSystemState()
        return all(
            self._stages(rig, published, topic) >= self._names(rig, [publisher]) and
            self._stages(rig, subscribed, topic) - {rospy.get_name()} == self._names(
                rig, subscribers) for rig in RIGS)

    def test_stages_hear_those_of_their_own_rig(self):
        for topic, (publisher, subscribers) in TOPICS.items():
            self.wait_for(lambda: self._wired(topic, publisher, subscribers),
                          'publisher and subscribers of their own for ' + topic)
        published, subscribed, _ = rosgraph.Master('/two_rigs_test').getSystemState()
        for topic, _ in published + subscribed:
            self.assertNotRegex(topic, '^/(feature_tracker|vins_estimator|pose_graph)/')

    def test_sensors_are_those_of_the_own_rig(self):
        imu = rospy.Publisher('/left/imu', Imu, queue_size=10)

        def told(rig, text):
            names = [name for name in self._statuses
                     if name.startswith(rig + '/') and name.endswith(': estimator')]
            return any(text in self._statuses[name] for name in names)

        self.wait_for(lambda: all(told(rig, 'no IMU sample yet on /%s/imu' % rig)
                                  for rig in RIGS), 'diagnostics of both estimators')
        sample = Imu()
        sample.linear_acceleration.z = 9.81
        for i in range(400):
            sample.header.stamp = rospy.Time(1000, 5000000 * (i % 200))
            imu.publish(sample)
            time.sleep(0.005)
        self.wait_for(lambda: told('left', 'no features yet on /left/feature_tracker/feature'),
                      'IMU samples at the left rig')
        self.assertTrue(told('right', 'no IMU sample yet'), self._statuses)

    def test_odometry_goes_to_the_own_map(self):
        publisher = rospy.Publisher('/left/vins_estimator/odometry', Odometry, queue_size=20)
        self.wait_for(lambda: publisher.get_num_connections() == 1, "the left rig's pose graph")
        for i in range(10):
            message = Odometry()
            message.header.stamp = rospy.Time(2000, 50000000 * i)
            message.header.frame_id = 'left/odom'
            message.child_frame_id = 'left/body'
            message.pose.pose.orientation.w = 1.0
            publisher.publish(message)
            time.sleep(0.02)
        self.wait_for(lambda: len(self._odometry['left']) == 10, "odometry in the left rig's map")
        with self._lock:
            self.assertEqual(self._odometry['left'][0].header.frame_id, 'left/map')
            self.assertEqual(self._odometry['left'][0].child_frame_id, 'left/body')
            self.assertEqual(self._odometry['right'], [])
            self.assertEqual(self._transforms, {('left/map', 'left/odom')})


if __name__ == '__main__':
    rospy.init_node('two_rigs_test')
    rostest.rosrun('vins_tests', 'two_rigs_test', TwoRigs)
