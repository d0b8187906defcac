#include "vins_estimator/window/marginalization.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "vins_estimator/factors/imu_factor.h"
#include "vins_estimator/window/linearization.h"

namespace vins::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Where the states' columns stand in the stacked system: the oldest frame's first, as they are to
/// go; then those of the poses and motions that stay and are touched.
class Columns {
 public:
  /// `rig_size`: number of the rig's variables; 0: it is not refined.
  Columns(std::size_t frames, Index rig_size)
      : pose_(frames, -1), motion_(frames, -1), rig_(rig_size > 0 ? 0 : -1), rig_size_(rig_size) {}

  void touchPose(std::size_t frame) { pose_[frame] = 0; }
  void touchMotion(std::size_t frame) { motion_[frame] = 0; }
  void assign() {
    touchPose(0);
    touchMotion(0);
    for (std::size_t frame = 0; frame < pose_.size(); ++frame) {
      if (pose_[frame] >= 0) take(6, &pose_[frame]);
      if (motion_[frame] >= 0) take(9, &motion_[frame]);
    }
    if (rig_ >= 0) take(rig_size_, &rig_);
  }
  Index pose(std::size_t frame) const { return pose_[frame]; }
  Index motion(std::size_t frame) const { return motion_[frame]; }
  Index rig() const { return rig_; }  ///< negative where the rig is not refined
  Index rigSize() const { return rig_size_; }
  Index of(const Prior::Part& part) const {
    if (part.kind == Prior::Kind::kRig) return rig_;
    return part.kind == Prior::Kind::kMotion ? motion_[part.frame] : pose_[part.frame];
  }
  Index count() const { return count_; }

 private:
  void take(Index size, Index* column) {
    *column = count_;
    count_ += size;
  }
  std::vector<Index> pose_;
  std::vector<Index> motion_;
  Index rig_;
  Index rig_size_;
  Index count_ = 0;
};

/// Rows A d + b, b standing in the last column of `rows`.
struct StackedSystem {
  MatrixXd rows;
  Index used = 0;

  Eigen::Block<MatrixXd> next(Index count) {
    used += count;
    return rows.middleRows(used - count, count);
  }
};

/// Landmarks that go with the oldest frame: it hosts them, and the newest frame has lost them.
std::vector<std::int64_t> landmarksToMarginalize(const SlidingWindow& window) {
  std::vector<std::int64_t> ids;
  const FrameId oldest = window.frames.front().id;
  const FrameId newest = window.frames.back().id;
  for (const auto& [id, landmark] : window.landmarks.tracks()) {
    if (landmark.has_depth && landmark.host() == oldest && !landmark.isSeenIn(newest)) {
      ids.push_back(id);
    }
  }
  return ids;
}

Columns layOut(const SlidingWindow& window, const std::vector<LinearizedLandmark>& landmarks) {
  Columns columns(window.frames.size(), window.refines_rig ? window.rig_variables.size() : 0);
  for (const Prior::Part& part : window.prior.parts) {
    if (part.kind == Prior::Kind::kPose) columns.touchPose(part.frame);
    if (part.kind == Prior::Kind::kMotion) columns.touchMotion(part.frame);
  }
  columns.touchPose(1);
  columns.touchMotion(1);
  for (const LinearizedLandmark& landmark : landmarks) {
    for (const auto& observation : landmark.observations) columns.touchPose(observation.target);
  }
  columns.assign();
  return columns;
}

void stackPrior(const Prior& prior, const Columns& columns, StackedSystem* system) {
  if (prior.empty()) return;
  auto rows = system->next(prior.A.rows());
  int column = 0;
  for (const Prior::Part& part : prior.parts) {
    rows.middleCols(columns.of(part), part.size()) = prior.A.middleCols(column, part.size());
    column += part.size();
  }
  rows.rightCols<1>() = prior.b;
}

void stackImu(const SlidingWindow& window, const Columns& columns, StackedSystem* system) {
  const WindowFrame& i = window.frames[0];
  const WindowFrame& j = window.frames[1];
  const ImuJacobians J =
      imuJacobians(j.imu, window.g_w, i.state.linearizationPoint(i.state.value()),
                   j.state.linearizationPoint(j.state.value()), window.rig.imu);
  const Matrix15d& weight = j.imu.sqrtInformation();
  const Vector15d r =
      imuResidual(j.imu, window.g_w, i.state.value(), j.state.value(), window.rig.imu);
  auto rows = system->next(15);
  rows.middleCols<6>(columns.pose(0)) = weight * J.J_pose_i;
  rows.middleCols<9>(columns.motion(0)) = weight * J.J_motion_i;
  rows.middleCols<6>(columns.pose(1)) = weight * J.J_pose_j;
  rows.middleCols<9>(columns.motion(1)) = weight * J.J_motion_j;
  if (columns.rig() >= 0 && window.rig_variables.imu) {
    rows.middleCols<15>(columns.rig() + window.rig_variables.cameraSize()) =
        weight * J.J_intrinsics;
  }
  rows.rightCols<1>() = weight * r;
}

/// The oldest frame's standing still.
void stackStillness(const SlidingWindow& window, const Columns& columns, StackedSystem* system) {
  const WindowFrame& oldest = window.frames.front();
  if (!oldest.stands_still) return;
  auto rows = system->next(3);
  rows.middleCols<3>(columns.motion(0)).diagonal().setConstant(1.0 / window.rest.velocity);
  rows.rightCols<1>() = oldest.state.value().v_w / window.rest.velocity;
}

/// That the body has rested from the oldest frame to the next.
void stackRest(const SlidingWindow& window, const Columns& columns, StackedSystem* system) {
  if (!window.frames[1].has_rested) return;
  const WindowState& i = window.frames[0].state;
  const WindowState& j = window.frames[1].state;
  Eigen::Matrix<double, 6, 6> J_i, J_j;
  zeroMotionResidual(window.rest, i.poseForJacobians(i.value().T_wb),
                     j.poseForJacobians(j.value().T_wb), &J_i, &J_j);
  auto rows = system->next(6);
  rows.middleCols<6>(columns.pose(0)) = J_i;
  rows.middleCols<6>(columns.pose(1)) = J_j;
  rows.rightCols<1>() =
      zeroMotionResidual(window.rest, i.value().T_wb, j.value().T_wb, nullptr, nullptr);
}

/// Stacks a landmark's rows, freed of the landmark: QR of its own three columns, whose rows go.
void stackLandmark(const LinearizedLandmark& landmark, const Columns& columns, Index rig_size,
                   StackedSystem* system) {
  const auto count = static_cast<Index>(landmark.observations.size());
  MatrixXd J_landmark(2 * count, 3);
  MatrixXd rows = MatrixXd::Zero(2 * count, system->rows.cols());
  const Index host = columns.pose(landmark.host);
  for (Index i = 0; i < count; ++i) {
    const LinearizedObservation& o = landmark.observations[static_cast<std::size_t>(i)];
    J_landmark.middleRows<2>(2 * i) = o.J_landmark;
    rows.block<2, 6>(2 * i, host) += o.J_host;
    rows.block<2, 6>(2 * i, columns.pose(o.target)) += o.J_target;
    if (columns.rig() >= 0) {
      rows.block(2 * i, columns.rig(), 2, rig_size) = o.J_rig.leftCols(rig_size);
    }
    rows.block<2, 1>(2 * i, rows.cols() - 1) = o.r;
  }
  const Eigen::HouseholderQR<Eigen::Ref<MatrixXd>> qr(J_landmark);
  rows.applyOnTheLeft(qr.householderQ().adjoint());
  system->next(2 * count - 3) = rows.bottomRows(2 * count - 3);
}

/// Where the rig's differences in the prior are zero: where they were so far.
RigCalibration rigZero(const SlidingWindow& window) {
  for (const Prior::Part& part : window.prior.parts) {
    if (part.kind == Prior::Kind::kRig) return part.rig_at;
  }
  return window.rig;
}

/// Rewrites rows about the present values as rows about the first estimates.
void shiftToFirstEstimates(const SlidingWindow& window, const Columns& columns, Index first_row,
                           StackedSystem* system) {
  auto rows = system->rows.middleRows(first_row, system->used - first_row);
  for (std::size_t frame = 0; frame < window.frames.size(); ++frame) {
    const WindowState& state = window.frames[frame].state;
    if (columns.pose(frame) >= 0) {
      rows.rightCols<1>() -= rows.middleCols<6>(columns.pose(frame)) * poseShift(state);
    }
    if (columns.motion(frame) >= 0) {
      rows.rightCols<1>() -= rows.middleCols<9>(columns.motion(frame)) * motionShift(state);
    }
  }
  if (columns.rig() >= 0) {
    rows.rightCols<1>() -= rows.middleCols(columns.rig(), columns.rigSize()) *
                           selected(window.rig_variables, minus(window.rig, rigZero(window)));
  }
}

/// Everything that the oldest frame is in, as rows.
StackedSystem stackAll(const SlidingWindow& window, const Columns& columns,
                       const std::vector<LinearizedLandmark>& landmarks) {
  Index count = window.prior.A.rows() + 15 + (window.frames.front().stands_still ? 3 : 0) +
                (window.frames[1].has_rested ? 6 : 0);
  for (const auto& landmark : landmarks) {
    count += 2 * static_cast<Index>(landmark.observations.size()) - 3;
  }
  StackedSystem system;
  system.rows = MatrixXd::Zero(count, columns.count() + 1);
  stackPrior(window.prior, columns, &system);
  const Index first_row = system.used;
  stackImu(window, columns, &system);
  stackStillness(window, columns, &system);
  stackRest(window, columns, &system);
  for (const auto& landmark : landmarks) {
    stackLandmark(landmark, columns, window.rig_variables.cameraSize(), &system);
  }
  shiftToFirstEstimates(window, columns, first_row, &system);
  return system;
}

/// The prior that is left of the rows when the first 15 columns are eliminated.
Prior eliminateOldest(const SlidingWindow& window, const Columns& columns, StackedSystem* system) {
  constexpr Index kGone = 15;
  const Eigen::HouseholderQR<Eigen::Ref<MatrixXd>> qr(system->rows);
  // Upper triangular now, right-hand side included; the row below the last state's holds what no
  // state can change.
  const Index kept = columns.count() - kGone;
  const Index rank = std::min(kept, system->rows.rows() - kGone);
  Prior prior;
  const MatrixXd R = system->rows.block(kGone, kGone, rank, kept + 1);
  prior.A = R.leftCols(kept).triangularView<Eigen::Upper>();
  prior.b = R.col(kept);
  for (std::size_t frame = 1; frame < window.frames.size(); ++frame) {
    const NavState& at = window.frames[frame].state.firstEstimate();
    if (columns.pose(frame) >= 0) {
      prior.parts.push_back({Prior::Kind::kPose, frame - 1, at, {}, {}});
    }
    if (columns.motion(frame) >= 0) {
      prior.parts.push_back({Prior::Kind::kMotion, frame - 1, at, {}, {}});
    }
  }
  if (columns.rig() >= 0) {
    prior.parts.push_back({Prior::Kind::kRig, 0, {}, rigZero(window), window.rig_variables});
  }
  return prior;
}

void fixTouchedStates(const Columns& columns, SlidingWindow* window) {
  for (std::size_t frame = 0; frame < window->frames.size(); ++frame) {
    WindowState& state = window->frames[frame].state;
    if (columns.pose(frame) >= 0) state.fixPose();
    if (columns.motion(frame) >= 0) state.fixMotion();
  }
}

}  // namespace

void marginalizeOldest(double huber, SlidingWindow* window) {
  const std::vector<std::int64_t> ids = landmarksToMarginalize(*window);
  const WindowGeometry geometry = geometryOf(*window, window->values());
  std::vector<LinearizedLandmark> landmarks;
  for (const std::int64_t id : ids) {
    landmarks.push_back(linearize(*window, geometry, window->landmarks.tracks().at(id), huber));
  }
  const Columns columns = layOut(*window, landmarks);
  fixTouchedStates(columns, window);
  StackedSystem system = stackAll(*window, columns, landmarks);
  Prior prior = eliminateOldest(*window, columns, &system);

  for (const std::int64_t id : ids) window->landmarks.remove(id);
  window->landmarks.removeFrame(window->frames.front().id, window->cameras());
  window->frames.erase(window->frames.begin());
  window->prior = std::move(prior);
}

}  // namespace vins::estimator
