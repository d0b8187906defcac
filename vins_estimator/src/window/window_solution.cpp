#include "vins_core/so3.h"
#include "vins_estimator/window/window_system.h"

namespace vins::estimator {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd WindowSystem::sqrtInformation() const {
  const auto L = llt_.matrixLLT().bottomRightCorner(stepCount(), stepCount());
  return MatrixXd(L.triangularView<Eigen::Lower>()).transpose();
}

VectorXd WindowSystem::sqrtGradient() const { return y_.tail(stepCount()); }

VectorXd WindowSystem::motionSteps(const VectorXd& steps) const {
  const auto motions = static_cast<Index>(9 * frameCount());
  const auto L = llt_.matrixLLT();
  // L_mm^T d_m = -(y_m + L_sm^T d_s)
  VectorXd motion_steps =
      -(y_.head(motions) + L.bottomLeftCorner(stepCount(), motions).transpose() * steps);
  L.topLeftCorner(motions, motions)
      .triangularView<Eigen::Lower>()
      .transpose()
      .solveInPlace(motion_steps);
  return motion_steps;
}

WindowSystem::Point WindowSystem::moved(const VectorXd& steps) const {
  const VectorXd motion_steps = motionSteps(steps);
  Point point = at_;
  for (std::size_t i = 0; i < frameCount(); ++i) {
    Vector15d d;
    d << steps.segment<6>(static_cast<Index>(6 * i)), motion_steps.segment<9>(motionColumn(i));
    point.values.states[i] = plus(at_.values.states[i], d);
  }
  for (Pose& old : point.values.old) {
    const Eigen::Matrix<double, 6, 1> d = steps.segment<6>(static_cast<Index>(6 * frameCount()));
    old.position += d.head<3>();
    old.rotation = (old.rotation * so3::exp(Eigen::Vector3d(d.tail<3>()))).normalized();
  }
  if (refinesRig()) {
    point.values.rig =
        plus(at_.values.rig, expanded(rigVariables(), RigStep(steps.tail(rigSize()))));
  }
  moveLandmarks(steps, &point.landmarks);
  return point;
}

void WindowSystem::moveLandmarks(const VectorXd& steps,
                                 std::vector<LandmarkParameters>* landmarks) const {
  for (std::size_t k = 0; k < landmarks_.size(); ++k) {
    Eigen::Vector3d g = eliminations_[k].g;
    for (std::size_t a = landmarks_[k].begin; a < landmarks_[k].end; ++a) {
      g += W_[a].transpose() * steps.segment<6>(static_cast<Index>(6 * observations_[a].target));
    }
    if (refinesRig()) {
      const Index shown = rigVariables().cameraSize();
      g += eliminations_[k].W_rig.topRows(shown).transpose() *
           steps.segment(stepCount() - rigSize(), shown);
    }
    (*landmarks)[k] -= eliminations_[k].H_inverse * g;
  }
}

Matrix15d WindowSystem::newestCovariance() const {
  const std::size_t newest = frameCount() - 1;
  Eigen::MatrixXd selection = MatrixXd::Zero(H_.rows(), 15);
  selection.block<6, 6>(poseColumn(newest), 0).setIdentity();
  selection.block<9, 9>(motionColumn(newest), 6).setIdentity();
  llt_.matrixL().solveInPlace(selection);
  return selection.transpose() * selection;
}

RigMatrix WindowSystem::rigCovariance() const {
  if (!refinesRig()) return RigMatrix::Zero();
  MatrixXd selection = MatrixXd::Zero(H_.rows(), rigSize());
  selection.bottomRows(rigSize()).setIdentity();
  llt_.matrixL().solveInPlace(selection);
  return expanded(rigVariables(), MatrixXd(selection.transpose() * selection));
}

Eigen::Matrix<double, 6, 6> WindowSystem::relativeCovariance(std::size_t a, std::size_t b) const {
  const Pose T_wa = poseOf(a);
  const Pose T_ab = T_wa.inverse() * poseOf(b);
  const Eigen::Matrix3d R_aw = T_wa.rotation.conjugate().toRotationMatrix();
  // Rows: derivatives of position and rotation (right) of T_ab by the two poses' errors.
  MatrixXd selection = MatrixXd::Zero(H_.rows(), 6);
  selection.block<3, 3>(poseColumn(a), 0) = -R_aw.transpose();
  selection.block<3, 3>(poseColumn(a) + 3, 0) = so3::hat(T_ab.position).transpose();
  selection.block<3, 3>(poseColumn(b), 0) = R_aw.transpose();
  selection.block<3, 3>(poseColumn(a) + 3, 3) = -T_ab.rotation.toRotationMatrix();
  selection.block<3, 3>(poseColumn(b) + 3, 3).setIdentity();
  llt_.matrixL().solveInPlace(selection);
  return selection.transpose() * selection;
}

const Pose& WindowSystem::poseOf(std::size_t view) const {
  return view < frameCount() ? at_.values.states[view].T_wb : at_.values.old[view - frameCount()];
}

MatrixXd WindowSystem::information() const {
  const MatrixXd whole = H_.selfadjointView<Eigen::Lower>();
  std::vector<Index> order;
  for (std::size_t frame = 0; frame < frameCount(); ++frame) {
    for (Index i = 0; i < 6; ++i) order.push_back(poseColumn(frame) + i);
    for (Index i = 0; i < 9; ++i) order.push_back(motionColumn(frame) + i);
  }
  return whole(order, order);
}

}  // namespace vins::estimator
