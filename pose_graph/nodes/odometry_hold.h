#pragma once

#include <deque>
#include <optional>
#include <vector>

#include <nav_msgs/Odometry.h>

#include "vins_core/keyframe.h"
#include "vins_core/time.h"

namespace vins::pose_graph {

/// Odometry messages do not say which sequence they are of; keyframes do, and come by another
/// topic, which may be slower. After a pause of the odometry, or where its stamps jump back, a
/// sequence may have begun: messages are then held until a keyframe has come, so that they are not
/// taken for the sequence before. A pause that was none of the estimator's brings no keyframe;
/// therefore only a few messages are held.
class OdometryHold {
 public:
  /// Takes a message; returns what can be handled now, in the order of arrival.
  std::vector<nav_msgs::Odometry> addOdometry(const nav_msgs::Odometry& odometry);

  /// To be called after each keyframe; returns what was held.
  std::vector<nav_msgs::Odometry> addKeyframe(const Keyframe& keyframe);

 private:
  bool followsPause(Stamp stamp) const;
  std::vector<nav_msgs::Odometry> release();

  std::deque<nav_msgs::Odometry> held_;
  std::optional<Stamp> last_;              ///< of the odometry that was let through last [ns]
  std::optional<std::uint32_t> sequence_;  ///< of the newest keyframe
  bool has_news_ = false;                  ///< a keyframe that is newer than `last_` has come
};

}  // namespace vins::pose_graph
