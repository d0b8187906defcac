#include "vins_estimator/window/linearization.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "vins_estimator/factors/imu_factor.h"

namespace vins {
namespace {

using Eigen::MatrixXd;
using Matrix63d = Eigen::Matrix<double, 6, 3>;

/// Scales a linearized observation by the square root of Huber's weight.
void scaleByLoss(double huber, LinearizedObservation* observation) {
  const double norm = observation->r.norm();
  if (norm <= huber) return;
  const double scale = std::sqrt(huber / norm);
  observation->J_host *= scale;
  observation->J_target *= scale;
  observation->J_landmark *= scale;
  observation->r *= scale;
}

/// Adds a landmark's information on the poses, itself eliminated by the Schur complement.
void addLandmark(const LinearizedLandmark& landmark, MatrixXd* H) {
  const auto pose = [](std::size_t frame) { return static_cast<Eigen::Index>(15 * frame); };
  const Eigen::Index host = pose(landmark.host);
  Eigen::Matrix3d H_ll = Eigen::Matrix3d::Zero();
  Matrix63d W_host = Matrix63d::Zero();
  std::vector<Matrix63d, Eigen::aligned_allocator<Matrix63d>> W;
  W.reserve(landmark.observations.size());
  for (const LinearizedObservation& o : landmark.observations) {
    H_ll += o.J_landmark.transpose() * o.J_landmark;
    W_host += o.J_host.transpose() * o.J_landmark;
    W.emplace_back(o.J_target.transpose() * o.J_landmark);
    const Eigen::Index target = pose(o.target);
    H->block<6, 6>(host, host) += o.J_host.transpose() * o.J_host;
    H->block<6, 6>(target, target) += o.J_target.transpose() * o.J_target;
    // The lower triangle only; the host stands before every target.
    H->block<6, 6>(target, host) += o.J_target.transpose() * o.J_host;
  }
  // The landmark's own information may be nearly singular along its depth.
  H_ll.diagonal().array() += 1e-6;
  const Eigen::Matrix3d H_ll_inverse = H_ll.inverse();
  W.front() = W_host;
  for (std::size_t a = 0; a < W.size(); ++a) {
    const Matrix63d left = W[a] * H_ll_inverse;
    for (std::size_t b = 0; b <= a; ++b) {
      H->block<6, 6>(pose(landmark.observations[a].target),
                     pose(landmark.observations[b].target)) -= left * W[b].transpose();
    }
  }
}

void addImu(const SlidingWindow& window, std::size_t index, MatrixXd* H) {
  const WindowFrame& to = window.frames[index];
  const WindowFrame& from = window.frames[index - 1];
  const auto at = [](const WindowState& state) {
    NavState point = state.motionForJacobians(state.value());
    point.T_wb = state.poseForJacobians(state.value().T_wb);
    return point;
  };
  const ImuJacobians J = imuJacobians(to.imu, window.g_w, at(from.state), at(to.state));
  Eigen::Matrix<double, 15, 30> whole;
  whole << J.J_pose_i, J.J_motion_i, J.J_pose_j, J.J_motion_j;
  whole = (to.imu.sqrtInformation() * whole).eval();
  const auto first = static_cast<Eigen::Index>(15 * (index - 1));
  H->block<30, 30>(first, first) += whole.transpose() * whole;
}

void addStillness(const SlidingWindow& window, MatrixXd* H) {
  const double weight = 1.0 / (window.still_velocity * window.still_velocity);
  for (std::size_t i = 0; i < window.frames.size(); ++i) {
    if (!window.frames[i].stands_still) continue;
    H->diagonal().segment<3>(static_cast<Eigen::Index>(15 * i) + kVelocity).array() += weight;
  }
}

void addPrior(const Prior& prior, MatrixXd* H) {
  if (prior.empty()) return;
  const MatrixXd information = prior.A.transpose() * prior.A;
  int row = 0;
  for (const Prior::Part& a : prior.parts) {
    int column = 0;
    for (const Prior::Part& b : prior.parts) {
      H->block(static_cast<Eigen::Index>(15 * a.frame) + (a.motion ? 6 : 0),
               static_cast<Eigen::Index>(15 * b.frame) + (b.motion ? 6 : 0), a.size(), b.size()) +=
          information.block(row, column, a.size(), b.size());
      column += b.size();
    }
    row += a.size();
  }
}

/// Information whose lower triangle counts.
MatrixXd lowerInformation(const SlidingWindow& window, double huber) {
  const auto size = static_cast<Eigen::Index>(15 * window.frames.size());
  MatrixXd H = MatrixXd::Zero(size, size);
  for (const auto& [id, landmark] : window.landmarks.tracks()) {
    if (landmark.has_depth) addLandmark(linearize(window, landmark, huber), &H);
  }
  for (std::size_t i = 1; i < window.frames.size(); ++i) addImu(window, i, &H);
  addStillness(window, &H);
  addPrior(window.prior, &H);
  return H;
}

}  // namespace

LinearizedLandmark linearize(const SlidingWindow& window, const Landmark& landmark, double huber) {
  LinearizedLandmark result;
  result.host = window.indexOf(landmark.host());
  const WindowState& host = window.frames[result.host].state;
  result.observations.resize(landmark.observations.size());
  for (std::size_t i = 0; i < landmark.observations.size(); ++i) {
    const TrackObservation& observation = landmark.observations[i];
    LinearizedObservation& out = result.observations[i];
    out.target = window.indexOf(observation.frame);
    if (i == 0) {
      out.J_host.setZero();
      out.J_target.setZero();
      out.r =
          hostResidual(observation.measured, landmark.anchor, landmark.parameters, &out.J_landmark);
    } else {
      const WindowState& target = window.frames[out.target].state;
      BearingJacobians J;
      out.r = firstEstimatesResidual(observation.measured, landmark.anchor, window.T_bc, host,
                                     host.value().T_wb, target, target.value().T_wb,
                                     landmark.parameters, &J);
      out.J_host = J.J_host;
      out.J_target = J.J_target;
      out.J_landmark = J.J_landmark;
    }
    scaleByLoss(huber, &out);
  }
  return result;
}

Eigen::Matrix<double, 6, 1> poseShift(const WindowState& state) {
  if (!state.isPoseFixed()) return Eigen::Matrix<double, 6, 1>::Zero();
  return minus(state.value(), state.firstEstimate()).head<6>();
}

Eigen::Matrix<double, 9, 1> motionShift(const WindowState& state) {
  if (!state.isMotionFixed()) return Eigen::Matrix<double, 9, 1>::Zero();
  return minus(state.value(), state.firstEstimate()).tail<9>();
}

MatrixXd windowInformation(const SlidingWindow& window, double huber) {
  return lowerInformation(window, huber).selfadjointView<Eigen::Lower>();
}

Matrix15d newestCovariance(const SlidingWindow& window, double huber) {
  // The newest state stands last: the last block of the Cholesky factor is that of its marginal.
  const Eigen::LLT<MatrixXd> llt(lowerInformation(window, huber));
  const Matrix15d L = llt.matrixLLT().bottomRightCorner<15, 15>().triangularView<Eigen::Lower>();
  const Matrix15d L_inverse = L.triangularView<Eigen::Lower>().solve(Matrix15d::Identity());
  return L_inverse.transpose() * L_inverse;
}

}  // namespace vins
