#include "vins_core/trajectory.h"

#include <algorithm>
#include <string>

#include "vins_core/input_error.h"

namespace vins {

Trajectory::Trajectory(const std::vector<StampedPose>& poses) {
  poses_.reserve(poses.size());
  for (const StampedPose& pose : poses) append(pose);
}

void Trajectory::append(const StampedPose& pose) {
  if (!poses_.empty() && pose.stamp <= poses_.back().stamp) {
    throw InputError("trajectory: stamp " + std::to_string(pose.stamp) + " ns follows " +
                     std::to_string(poses_.back().stamp) + " ns; stamps must rise");
  }
  poses_.push_back(pose);
}

double Trajectory::duration() const {
  return poses_.empty() ? 0.0 : toSeconds(poses_.back().stamp - poses_.front().stamp);
}

double Trajectory::length() const {
  double sum = 0.0;
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    sum += (poses_[i].T_wb.position - poses_[i - 1].T_wb.position).norm();
  }
  return sum;
}

std::optional<Pose> Trajectory::interpolate(Stamp stamp, double max_gap) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), stamp,
                       [](const StampedPose& pose, Stamp value) { return pose.stamp < value; });
  if (after == poses_.end()) return std::nullopt;
  if (after->stamp == stamp) return after->T_wb;
  if (after == poses_.begin()) return std::nullopt;
  const auto before = after - 1;
  const double gap = toSeconds(after->stamp - before->stamp);
  if (gap > max_gap) return std::nullopt;
  const double share = toSeconds(stamp - before->stamp) / gap;
  return Pose(before->T_wb.rotation.slerp(share, after->T_wb.rotation),
              (1.0 - share) * before->T_wb.position + share * after->T_wb.position);
}

}  // namespace vins
