#include "vins_estimator/window/rig_score.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "vins_estimator/factors/imu_factor.h"
#include "vins_estimator/window/linearization.h"

namespace vins::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix29d = Eigen::Matrix<double, 2, 9>;

/// The window's frames and tracks alone, linearized where they stand now, the rig an unknown.
SlidingWindow withoutPast(const SlidingWindow& window) {
  SlidingWindow alone = window;
  alone.prior = Prior();
  alone.loop.reset();
  alone.refines_rig = true;
  alone.rig_variables = {true, false};  // of the camera's errors, too, not of the IMU's
  for (WindowFrame& frame : alone.frames) frame.state.ignoreFirstEstimates();
  return alone;
}

bool canBeScored(const SlidingWindow& window) {
  if (window.frames.size() < 2) return false;
  const auto moves = [](const WindowFrame& frame) {
    return !frame.stands_still && !frame.has_rested;
  };
  const auto is_weightable = [](const WindowFrame& frame) { return frame.imu.isWeightable(); };
  return std::all_of(window.frames.begin(), window.frames.end(), moves) &&
         std::all_of(window.frames.begin() + 1, window.frames.end(), is_weightable);
}

/// Derivatives by RigErrorVector; a focal length that is wrong is wrong in both directions.
Matrix29d byRigErrors(const LinearizedObservation& observation) {
  Matrix29d J;
  J << observation.J_rig.leftCols<kIntrinsics>(),
      observation.J_rig.middleCols<2>(kIntrinsics).rowwise().sum();
  return J;
}

/// Normal equations of all that a window's residuals depend on, landmarks eliminated. Unknowns:
/// velocities and biases of the frames, their poses, the rig's errors.
class ScoreSystem {
 public:
  ScoreSystem(const SlidingWindow& window, double huber)
      : window_(window),
        huber_(huber),
        values_(window.values()),
        geometry_(geometryOf(window, values_)),
        H_(MatrixXd::Zero(size(), size())),
        g_(VectorXd::Zero(size())) {}

  void addLandmark(const Landmark& landmark) {
    const LinearizedLandmark linearized = linearize(window_, geometry_, landmark, huber_);
    const auto rows = static_cast<Index>(2 * linearized.observations.size());
    LandmarkRows stacked{MatrixXd::Zero(rows, visualCount()), MatrixXd(rows, 3), VectorXd(rows)};
    Index row = 0;
    for (const LinearizedObservation& o : linearized.observations) {
      stacked.J.block<2, 6>(row, 6 * static_cast<Index>(linearized.host)) += o.J_host;
      stacked.J.block<2, 6>(row, 6 * static_cast<Index>(o.target)) += o.J_target;
      stacked.J.block<2, 9>(row, 6 * frameCount()) = byRigErrors(o);
      stacked.J_landmark.middleRows<2>(row) = o.J_landmark;
      stacked.r.segment<2>(row) = o.r;
      row += 2;
    }
    eliminate(stacked);
  }

  /// The IMU between a frame and the one before it.
  void addImu(std::size_t frame) {
    const NavState& i = values_.states[frame - 1];
    const NavState& j = values_.states[frame];
    const WeightedImuRows rows =
        weightedImuRows(window_.frames[frame].imu, window_.g_w, i, j, i, j, values_.rig.imu);
    const auto J_motion = rows.J.leftCols<18>();
    const auto J_pose = rows.J.rightCols<12>();
    const Index motion = 9 * static_cast<Index>(frame - 1), pose = poseColumn(frame - 1);
    H_.block<18, 18>(motion, motion) += J_motion.transpose() * J_motion;
    H_.block<12, 18>(pose, motion) += J_pose.transpose() * J_motion;
    H_.block<12, 12>(pose, pose) += J_pose.transpose() * J_pose;
    g_.segment<18>(motion) += J_motion.transpose() * rows.r;
    g_.segment<12>(pose) += J_pose.transpose() * rows.r;
    cost_ += 0.5 * rows.r.squaredNorm();
  }

  /// What no measurement tells, place and heading, is held at the first frame; its biases are
  /// known as well as those of any IMU in use.
  void addGauge() {
    constexpr double kPlace = 0.01, kHeading = 0.01;  // [m], [rad]; any value would do
    constexpr double kAccelerometerBias = 0.2;        // [m/s^2]
    constexpr double kGyroscopeBias = 0.02;           // [rad/s]
    const auto weight = [](double sigma) { return 1.0 / (sigma * sigma); };
    const Index pose = poseColumn(0);
    const Vector3d up_b = values_.states[0].T_wb.rotation.conjugate() * Vector3d::UnitZ();
    H_.diagonal().segment<3>(3).array() += weight(kAccelerometerBias);
    H_.diagonal().segment<3>(6).array() += weight(kGyroscopeBias);
    H_.diagonal().segment<3>(pose).array() += weight(kPlace);
    H_.block<3, 3>(pose + 3, pose + 3) += weight(kHeading) * up_b * up_b.transpose();
  }

  /// The rig's part, all states eliminated.
  std::optional<RigScore> solve() const {
    const Index states = rigColumn();
    const Eigen::LLT<MatrixXd> llt(H_.topLeftCorner(states, states));
    if (llt.info() != Eigen::Success) return std::nullopt;
    const auto across = H_.bottomLeftCorner(9, states);
    const MatrixXd moved = llt.solve(across.transpose());
    RigScore score;
    score.information = H_.bottomRightCorner<9, 9>() - across * moved;
    score.gradient = g_.tail<9>() - moved.transpose() * g_.head(states);
    score.cost = cost_;
    const bool is_finite = score.information.allFinite() && score.gradient.allFinite();
    return is_finite ? std::optional<RigScore>(score) : std::nullopt;
  }

 private:
  /// A landmark's rows, weighted.
  struct LandmarkRows {
    MatrixXd J;           ///< by poses and the rig
    MatrixXd J_landmark;  ///< three columns
    VectorXd r;
  };

  Index frameCount() const { return static_cast<Index>(window_.frames.size()); }
  Index poseColumn(std::size_t frame) const {
    return 9 * frameCount() + 6 * static_cast<Index>(frame);
  }
  Index rigColumn() const { return 15 * frameCount(); }
  Index size() const { return rigColumn() + 9; }
  Index visualCount() const { return 6 * frameCount() + 9; }

  /// Adds the rows, their landmark eliminated.
  void eliminate(const LandmarkRows& rows) {
    Eigen::Matrix3d H_ll = rows.J_landmark.transpose() * rows.J_landmark;
    H_ll.diagonal().array() += kLandmarkDamping;
    const MatrixXd W = rows.J.transpose() * rows.J_landmark;
    const MatrixXd left = W * H_ll.inverse();
    auto H = H_.bottomRightCorner(visualCount(), visualCount());
    H.noalias() += rows.J.transpose() * rows.J;
    H.noalias() -= left * W.transpose();
    g_.tail(visualCount()) +=
        rows.J.transpose() * rows.r - left * (rows.J_landmark.transpose() * rows.r);
    cost_ += 0.5 * rows.r.squaredNorm();
  }

  const SlidingWindow& window_;
  double huber_;
  WindowValues values_;
  WindowGeometry geometry_;
  MatrixXd H_;  ///< lower triangle; whole among poses and rig
  VectorXd g_;
  double cost_ = 0.0;
};

}  // namespace

std::optional<RigScore> scoreRig(const SlidingWindow& window, double huber) {
  if (!canBeScored(window)) return std::nullopt;
  const SlidingWindow alone = withoutPast(window);
  ScoreSystem system(alone, huber);
  for (const auto& [id, landmark] : alone.landmarks.tracks()) {
    if (landmark.has_depth) system.addLandmark(landmark);
  }
  for (std::size_t frame = 1; frame < alone.frames.size(); ++frame) system.addImu(frame);
  system.addGauge();
  return system.solve();
}

}  // namespace vins::estimator
