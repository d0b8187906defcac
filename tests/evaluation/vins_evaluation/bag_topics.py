"""Trajectories from topics of ROS 1 bags.

rosbag is imported only when a bag is asked for, so that text files can be
evaluated where ROS is not installed.
"""

import os

from vins_evaluation.errors import EvaluationError
from vins_evaluation.pose_collector import PoseCollector


def _pose(pose):
    p, q = pose.position, pose.orientation
    return (p.x, p.y, p.z), (q.x, q.y, q.z, q.w)


def _transform(transform):
    p, q = transform.translation, transform.rotation
    return (p.x, p.y, p.z), (q.x, q.y, q.z, q.w)


def _point(point):
    return (point.x, point.y, point.z), None


# message type -> function from a message to (position, quaternion x y z w)
_READERS = {
    "geometry_msgs/PoseStamped": lambda message: _pose(message.pose),
    "geometry_msgs/PoseWithCovarianceStamped": lambda message: _pose(message.pose.pose),
    "geometry_msgs/TransformStamped": lambda message: _transform(message.transform),
    "geometry_msgs/PointStamped": lambda message: _point(message.point),
    "nav_msgs/Odometry": lambda message: _pose(message.pose.pose),
}
_PATH = "nav_msgs/Path"


def read_bag_topic(path, topic):
    """Read the poses of a topic by their header stamps.

    Of a nav_msgs/Path the last message is the trajectory.

    Args:
        path: of the bag.
        topic: its name; empty if the user gave none.
    Returns:
        the Trajectory and a list of warnings (str).
    Raises:
        EvaluationError naming bag, topic and message.
    """
    rosbag = _import_rosbag(path)
    if not os.path.isfile(path):
        raise EvaluationError("%s: no such bag" % path)
    try:
        with rosbag.Bag(path) as bag:
            return _read(bag, path, topic)
    except rosbag.ROSBagUnindexedException as error:
        raise EvaluationError("%s: bag has no index: run rosbag reindex" % path) from error
    except (rosbag.ROSBagException, OSError) as error:
        raise EvaluationError("%s: cannot read the bag: %s" % (path, error)) from error


def _import_rosbag(path):
    try:
        import rosbag
    except ImportError as error:
        raise EvaluationError(
            "%s: reading bags needs ROS's Python package rosbag (package "
            "python3-rosbag, or source ROS's setup.bash): %s" % (path, error)) from error
    return rosbag


def _read(bag, path, topic):
    types = {name: info.msg_type
             for name, info in bag.get_type_and_topic_info().topics.items()}
    kind = types.get(topic)
    if kind != _PATH and kind not in _READERS:
        raise EvaluationError(_unusable(path, topic, types))
    messages = (message for _, message, _ in bag.read_messages(topics=[topic]))
    source = "%s:%s" % (path, topic)
    if kind == _PATH:
        return _collect_path(messages, source)
    return _collect(messages, _READERS[kind], PoseCollector(source, "message"))


def _unusable(path, topic, types):
    usable = sorted("%s (%s)" % (name, kind) for name, kind in types.items()
                    if kind == _PATH or kind in _READERS)
    if not topic:
        problem = "name a topic, %s:/topic" % path
    elif topic in types:
        problem = "topic %s is of type %s, which has no pose" % (topic, types[topic])
    else:
        problem = "no topic %s" % topic
    return "%s: %s; topics with poses: %s" % (path, problem, ", ".join(usable) or "none")


def _collect_path(messages, source):
    last = None
    for last in messages:
        pass
    poses = last.poses if last is not None else []
    collector = PoseCollector(source + ", last message", "pose")
    return _collect(poses, _READERS["geometry_msgs/PoseStamped"], collector)


def _collect(messages, reader, collector):
    for number, message in enumerate(messages, 1):
        stamp = message.header.stamp.to_nsec()
        if stamp == 0:
            collector.fail(number, "header has no stamp")
        collector.add(number, stamp, *reader(message))
    return collector.trajectory(), collector.warnings()
