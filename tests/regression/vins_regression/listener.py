"""Everything that the three nodes say, as it comes."""

import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from tf2_msgs.msg import TFMessage
from vins_msgs.msg import Event, LoopEdge, LoopMatch

from vins_regression import topics


class Listener:
    """Collects messages from its making on; needs an initialised rospy.

    Attributes (lists grow while somebody reads them; take them by `since`):
        odometry: StampedPose of /vins_estimator/odometry.
        corrected: StampedPose of /pose_graph/odometry.
        propagated: (stamp, arrival) of /vins_estimator/imu_propagate.
        frames: (stamp, sequence) of /feature_tracker/feature.
        loops: vins_msgs/LoopMatch.
        loop_edges: vins_msgs/LoopEdge, as the estimator gives refined loops back.
        events: Told, of estimator and pose graph.
        transforms: set of (parent, child).
        diagnostics: {name of a status: {key: value}}, the latest.
        levels: {name of a status: latest level}.
    """

    def __init__(self):
        self.odometry, self.corrected, self.propagated = [], [], []
        self.frames, self.loops, self.loop_edges, self.events = [], [], [], []
        self.transforms = set()
        self.diagnostics, self.levels = {}, {}
        self._changed = threading.Condition()
        self._subscribers = [
            self._hear("/vins_estimator/odometry", Odometry, self._on_pose(self.odometry)),
            self._hear("/pose_graph/odometry", Odometry, self._on_pose(self.corrected)),
            self._hear("/vins_estimator/imu_propagate", Odometry, self._on_propagated),
            self._hear("/feature_tracker/feature", rospy.AnyMsg,
                       lambda message: self.frames.append(topics.frame_number(message))),
            self._hear("/pose_graph/loop_match", LoopMatch, self.loops.append),
            self._hear("/vins_estimator/loop_edge", LoopEdge, self.loop_edges.append),
            self._hear("/vins_estimator/event", Event, self._on_event),
            self._hear("/pose_graph/event", Event, self._on_event),
            self._hear("/tf", TFMessage, self._on_transforms),
            self._hear("/diagnostics", DiagnosticArray, self._on_diagnostics)]

    def close(self):
        """Hears no more."""
        for subscriber in self._subscribers:
            subscriber.unregister()

    def wait_for(self, condition, timeout):
        """Whether condition(), asked after each message, came true within timeout seconds."""
        with self._changed:
            return self._changed.wait_for(condition, timeout)

    def codes(self):
        """Codes of the events so far."""
        return [event.code for event in self.events]

    def _hear(self, topic, kind, callback):
        def take(message):
            callback(message)
            with self._changed:
                self._changed.notify_all()
        return rospy.Subscriber(topic, kind, take, queue_size=1000, tcp_nodelay=True)

    @staticmethod
    def _on_pose(poses):
        return lambda message: poses.append(topics.pose_of(message, time.monotonic()))

    def _on_propagated(self, message):
        self.propagated.append((topics.stamp_of(message.header), time.monotonic()))

    def _on_event(self, message):
        self.events.append(topics.told(message))

    def _on_transforms(self, message):
        for transform in message.transforms:
            self.transforms.add((transform.header.frame_id, transform.child_frame_id))

    def _on_diagnostics(self, message):
        for status in message.status:
            self.diagnostics[status.name] = {item.key: item.value for item in status.values}
            self.levels[status.name] = status.level
