#include "odometry_hold.h"

#include "vins_msgs/conversions.h"

namespace vins::pose_graph {

std::vector<nav_msgs::Odometry> OdometryHold::addOdometry(const nav_msgs::Odometry& odometry) {
  constexpr std::size_t kMostHeld = 5;  // messages: a quarter of a second at 20 Hz
  held_.push_back(odometry);
  const bool waits = followsPause(vins_msgs::toStamp(held_.front().header.stamp)) && !has_news_;
  if (waits && held_.size() < kMostHeld) return {};
  return release();
}

std::vector<nav_msgs::Odometry> OdometryHold::addKeyframe(const Keyframe& keyframe) {
  has_news_ = has_news_ || sequence_ != keyframe.sequence || (last_ && keyframe.stamp > *last_);
  sequence_ = keyframe.sequence;
  return has_news_ && !held_.empty() ? release() : std::vector<nav_msgs::Odometry>();
}

bool OdometryHold::followsPause(Stamp stamp) const {
  constexpr Stamp kPause = 500'000'000;  // [ns]; an initialization takes longer than that
  return !last_ || stamp < *last_ || stamp > *last_ + kPause;
}

std::vector<nav_msgs::Odometry> OdometryHold::release() {
  const std::vector<nav_msgs::Odometry> released(held_.begin(), held_.end());
  held_.clear();
  last_ = vins_msgs::toStamp(released.back().header.stamp);
  has_news_ = false;
  return released;
}

}  // namespace vins::pose_graph
