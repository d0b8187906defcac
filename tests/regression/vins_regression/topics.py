"""Messages turned into what is judged: stamps in nanoseconds, poses as arrays."""

import collections
import struct

import numpy as np

# A pose with its covariance, (6, 6) of position and rotation; quaternion x y z w.
StampedPose = collections.namedtuple(
    "StampedPose", "stamp arrival frame child position quaternion covariance")
Told = collections.namedtuple("Told", "stamp code text figures")


def stamp_of(header):
    """Nanoseconds."""
    return header.stamp.secs * 1000000000 + header.stamp.nsecs


def pose_of(message, arrival):
    """StampedPose of a nav_msgs/Odometry that arrived at a time (seconds)."""
    return StampedPose(
        stamp_of(message.header), arrival, message.header.frame_id, message.child_frame_id,
        *_coordinates(message.pose.pose), np.array(message.pose.covariance).reshape(6, 6))


def poses_of(path):
    """StampedPoses of a nav_msgs/Path, which knows neither arrivals nor covariances."""
    return [StampedPose(stamp_of(item.header), None, path.header.frame_id, "",
                        *_coordinates(item.pose), None) for item in path.poses]


def told(message):
    """Told of a vins_msgs/Event."""
    return Told(stamp_of(message.header), message.code, message.text,
                dict(zip(message.figure_names, message.figure_values)))


def frame_number(message):
    """Stamp and sequence of a vins_msgs/FeatureFrame that came as AnyMsg.

    Its hundreds of observations are left packed: unpacking them all would take the time of the
    nodes under test.
    """
    _, seconds, nanoseconds, length = struct.unpack_from("<4I", message._buff)
    sequence, = struct.unpack_from("<I", message._buff, 16 + length)
    return seconds * 1000000000 + nanoseconds, sequence


def _coordinates(pose):
    """Position and quaternion of a geometry_msgs/Pose."""
    return ((pose.position.x, pose.position.y, pose.position.z),
            (pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w))
