#include "vins_pipeline/run_results.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <utility>
#include <vector>

#include "vins_core/trajectory_file.h"
#include "vins_pipeline/rig_summary.h"

namespace vins::pipeline {
namespace {

std::string csvLine(const estimator::Odometry& odometry) {
  const Pose& T = odometry.state.T_wb;
  const Eigen::Vector3d& v = odometry.state.v_w;
  char line[320];
  std::snprintf(line, sizeof(line), "%lld,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,\n",
                static_cast<long long>(odometry.stamp), T.position.x(), T.position.y(),
                T.position.z(), T.rotation.w(), T.rotation.x(), T.rotation.y(), T.rotation.z(),
                v.x(), v.y(), v.z());
  return line;
}

/// TUM's form without the quaternion.
std::string positionLine(const StampedPose& pose) {
  const std::string line = toTumLine(pose);
  std::size_t end = 0;
  for (int field = 0; field < 4; ++field) end = line.find(' ', end + 1);
  return line.substr(0, end);
}

}  // namespace

void RunResults::add(const PipelineResult& result) {
  if (!first_image_) first_image_ = result.stamp;
  ++images_;
  features_ = result.frame ? result.frame->observations.size() : 0;
  for (const estimator::EstimatorResult& estimate : result.estimates) add(estimate);
  for (const Event& event : result.events) add(event);
}

void RunResults::add(const Event& event) {
  if (event.severity != Severity::kInfo) ++warnings_[event.code];
}

void RunResults::add(const estimator::EstimatorResult& estimate) {
  ++frames_;
  status_ = estimate.status;
  if (!estimate.odometry) return;
  td_[estimate.odometry->stamp] = estimate.rig.td;
  rig_ = estimate.rig;
  rig_covariance_ = estimate.rig_covariance;
  add(*estimate.odometry);
}

std::optional<Trajectory> RunResults::atImuTime(const Trajectory& poses) const {
  constexpr Stamp kRounding = 1'000;  // of stamps in text files [ns]
  const auto is_zero = [](const auto& frame) { return frame.second == 0.0; };
  if (std::all_of(td_.begin(), td_.end(), is_zero)) return std::nullopt;
  std::vector<StampedPose> shifted;
  for (StampedPose pose : poses.poses()) {
    const auto after = td_.upper_bound(pose.stamp + kRounding);
    const double td = after == td_.begin() ? after->second : std::prev(after)->second;
    pose.stamp += toNanoseconds(td);
    // A td that falls by more than a frame's interval would turn the order.
    if (shifted.empty() || pose.stamp > shifted.back().stamp) shifted.push_back(pose);
  }
  return Trajectory(shifted);
}

void RunResults::add(const estimator::Odometry& odometry) {
  ++odometries_;
  if (!first_odometry_) first_odometry_ = odometry.stamp;
  vio_live_ += toTumLine({odometry.stamp, odometry.state.T_wb}) + "\n";
  vins_mono_csv_ += csvLine(odometry);
  if (last_odometry_ && last_odometry_->sequence == odometry.sequence) {
    const Eigen::Vector3d step = odometry.state.T_wb.position - last_odometry_->state.T_wb.position;
    path_length_ += step.norm();
  } else if (last_odometry_) {
    ++resets_;
  }
  last_odometry_ = odometry;
}

void RunResults::add(const RecordedTruth& truth) {
  // Recorded truth may repeat a stamp; the evaluation takes rising ones.
  if (last_truth_ && truth.stamp <= *last_truth_) return;
  last_truth_ = truth.stamp;
  const StampedPose pose{truth.stamp, truth.T_wb};
  ground_truth_ += (truth.has_rotation ? toTumLine(pose) : positionLine(pose)) + "\n";
}

std::optional<double> RunResults::initialisedAfter() const {
  if (!first_odometry_ || !first_image_) return std::nullopt;
  return toSeconds(*first_odometry_ - *first_image_);
}

std::string RunResults::rig() const { return describeRig(rig_, rig_covariance_); }

std::string RunResults::state() const {
  return std::to_string(features_) + " features, " + toString(status_);
}

}  // namespace vins::pipeline
