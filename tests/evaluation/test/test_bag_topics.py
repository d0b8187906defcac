"""Every message type that has a pose, from a bag that the test writes."""

import unittest
from unittest import mock

import numpy as np
from support import FolderTest, about

from vins_evaluation.bag_topics import read_bag_topic
from vins_evaluation.errors import EvaluationError
from vins_evaluation.sources import load

try:
    import genpy
    import rosbag
    from geometry_msgs.msg import (
        PointStamped, PoseStamped, PoseWithCovarianceStamped, TransformStamped)
    from nav_msgs.msg import Odometry, Path
    from std_msgs.msg import String
except ImportError as error:
    MISSING = str(error)
else:
    MISSING = ""

STAMPS = [1403715274302142976, 1403715274307142913]
POSITIONS = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
QUATERNIONS = about([1, 2, 3], np.array([20.0, 50.0]))


def set_xyz(target, values):
    target.x, target.y, target.z = values


def set_pose(pose, position, quaternion):
    set_xyz(pose.position, position)
    set_xyz(pose.orientation, quaternion[:3])
    pose.orientation.w = quaternion[3]


def pose_stamped(index):
    message = stamped(PoseStamped(), index)
    set_pose(message.pose, POSITIONS[index], QUATERNIONS[index])
    return message


def stamped(message, index):
    message.header.stamp = genpy.Time(*divmod(STAMPS[index], 10**9))
    return message


def pose_with_covariance(kind, index):
    message = stamped(kind(), index)
    set_pose(message.pose.pose, POSITIONS[index], QUATERNIONS[index])
    return message


def transform(index):
    message = stamped(TransformStamped(), index)
    set_xyz(message.transform.translation, POSITIONS[index])
    set_xyz(message.transform.rotation, QUATERNIONS[index][:3])
    message.transform.rotation.w = QUATERNIONS[index][3]
    return message


def point(index):
    message = stamped(PointStamped(), index)
    set_xyz(message.point, POSITIONS[index])
    return message


def path_up_to(index):
    message = stamped(Path(), index)
    message.poses = [pose_stamped(i) for i in range(index + 1)]
    return message


@unittest.skipIf(MISSING, "reading bags is not tested: %s" % MISSING)
class BagTopicsTest(FolderTest):

    def bag(self, topics):
        """Write {topic: messages}; returns the bag's path."""
        path = self.path("run.bag")
        with rosbag.Bag(path, "w") as bag:
            for topic, messages in topics.items():
                for second, message in enumerate(messages, 1):
                    bag.write(topic, message, genpy.Time(second))
        return path

    def assert_read(self, messages):
        found = load(self.bag({"/other": [String("x")], "/pose": messages}) + ":/pose")
        self.assertEqual(found.trajectory.stamps.tolist(), STAMPS)
        np.testing.assert_array_equal(found.trajectory.positions, POSITIONS)
        if found.trajectory.has_orientation:
            np.testing.assert_allclose(found.trajectory.quaternions, QUATERNIONS, atol=1e-15)
        return found

    def assert_complaint(self, pattern, topic, topics):
        path = self.bag(topics)
        with self.assertRaisesRegex(EvaluationError, pattern) as caught:
            read_bag_topic(path, topic)
        self.assertIn(path, str(caught.exception))

    def test_each_type_with_a_pose(self):
        covariances = [Odometry, PoseWithCovarianceStamped]
        topics = [[pose_with_covariance(kind, i) for i in (0, 1)] for kind in covariances]
        topics += [[make(i) for i in (0, 1)] for make in (pose_stamped, transform)]
        for messages in topics:
            self.assertTrue(self.assert_read(messages).trajectory.has_orientation)

    def test_points_have_no_rotation(self):
        self.assertFalse(self.assert_read([point(0), point(1)]).trajectory.has_orientation)

    def test_the_last_path_counts(self):
        self.assert_read([path_up_to(0), path_up_to(1)])

    def test_repeated_messages_are_dropped_and_told(self):
        found = self.assert_read([point(0), point(1), point(1)])
        self.assertRegex(found.warnings[0], "run.bag:/pose: dropped 1 .* at message 3")

    def test_a_bag_without_a_topic_lists_those_with_poses(self):
        path = self.bag({"/other": [String("x")], "/pose": [pose_stamped(0)]})
        with self.assertRaisesRegex(
                EvaluationError, r"name a topic.*: /pose \(geometry_msgs/PoseStamped\)$"):
            load(path)

    def test_topics_that_cannot_be_used(self):
        topics = {"/other": [String("x")], "/pose": [pose_stamped(0)]}
        self.assert_complaint("no topic /pos; topics with poses: /pose", "/pos", topics)
        self.assert_complaint("/other is of type std_msgs/String, which has no pose",
                              "/other", topics)
        self.assert_complaint("topics with poses: none", "/x", {"/other": [String("x")]})

    def test_messages_that_cannot_be_used(self):
        self.assert_complaint("/pose, message 2: stamp goes back", "/pose",
                              {"/pose": [point(1), point(0)]})
        self.assert_complaint("/pose, message 1: header has no stamp", "/pose",
                              {"/pose": [PointStamped()]})
        unset = stamped(PoseStamped(), 0)
        self.assert_complaint("/pose, message 1: quaternion .* norm 0", "/pose",
                              {"/pose": [unset]})
        self.assert_complaint("/path, last message, pose 2: stamp goes back", "/path",
                              {"/path": [self.disordered_path()]})
        self.assert_complaint("/path, last message: no poses", "/path", {"/path": [Path()]})

    @staticmethod
    def disordered_path():
        message = Path()
        message.poses = [pose_stamped(1), pose_stamped(0)]
        return message

    def test_files_that_are_no_bag(self):
        with self.assertRaisesRegex(EvaluationError, "absent.bag: no such bag"):
            read_bag_topic(self.path("absent.bag"), "/pose")
        for text in ("", "no bag at all\n"):
            with self.assertRaisesRegex(EvaluationError, "wrong.bag: cannot read the bag"):
                read_bag_topic(self.file("wrong.bag", text), "/pose")

    def test_a_bag_cut_short(self):
        path = self.bag({"/pose": [pose_stamped(0), pose_stamped(1)]})
        with open(path, "rb") as file:
            beginning = file.read()
        for length in (20, len(beginning) // 2, len(beginning) - 10):
            with open(path, "wb") as file:
                file.write(beginning[:length])
            with self.assertRaisesRegex(EvaluationError, "run.bag: "):
                read_bag_topic(path, "/pose")


class WithoutRosTest(unittest.TestCase):

    def test_says_what_is_missing(self):
        with mock.patch.dict("sys.modules", {"rosbag": None}):
            with self.assertRaisesRegex(EvaluationError, "x.bag: .*python3-rosbag"):
                read_bag_topic("x.bag", "/pose")


if __name__ == "__main__":
    unittest.main()
