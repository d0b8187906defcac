#include "vins_estimator/factors/prior_factor.h"

#include "vins_estimator/factors/parameter_blocks.h"

namespace vins::estimator {
namespace {

NavState stateOf(const Prior::Part& part, const double* block) {
  NavState state = part.at;
  if (part.kind == Prior::Kind::kMotion) {
    setMotion(block, &state);
  } else {
    state.T_wb = toPose(block);
  }
  return state;
}

}  // namespace

int Prior::Part::size() const {
  switch (kind) {
    case Kind::kPose:
      return 6;
    case Kind::kMotion:
      return 9;
    case Kind::kRig:
      return rig_variables.size();
  }
  return 0;
}

int Prior::columns() const {
  int columns = 0;
  for (const Part& part : parts) columns += part.size();
  return columns;
}

Eigen::VectorXd priorDifference(const Prior::Part& part, const NavState& state,
                                const RigCalibration& rig) {
  if (part.kind == Prior::Kind::kRig) {
    return selected(part.rig_variables, minus(rig, part.rig_at));
  }
  const Vector15d d = minus(state, part.at);
  return part.kind == Prior::Kind::kMotion ? Eigen::VectorXd(d.tail<9>())
                                           : Eigen::VectorXd(d.head<6>());
}

PriorFactor::PriorFactor(const Prior& prior) : prior_(prior) {
  set_num_residuals(static_cast<int>(prior.A.rows()));
  for (const Prior::Part& part : prior.parts) {
    mutable_parameter_block_sizes()->push_back(part.kind == Prior::Kind::kMotion ? 9 : 7);
  }
}

bool PriorFactor::Evaluate(double const* const* parameters, double* residuals,
                           double** jacobians) const {
  Eigen::VectorXd d(prior_.columns());
  int column = 0;
  for (std::size_t k = 0; k < prior_.parts.size(); ++k) {
    const Prior::Part& part = prior_.parts[k];
    d.segment(column, part.size()) = priorDifference(part, stateOf(part, parameters[k]), {});
    column += part.size();
  }
  Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()).noalias() = prior_.A * d + prior_.b;
  if (jacobians == nullptr) return true;
  column = 0;
  for (std::size_t k = 0; k < prior_.parts.size(); ++k) {
    const int size = prior_.parts[k].size();
    if (jacobians[k] != nullptr) {
      using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajorMatrix> J(jacobians[k], num_residuals(), parameter_block_sizes()[k]);
      J.leftCols(size) = prior_.A.middleCols(column, size);
      if (J.cols() > size) J.rightCols(J.cols() - size).setZero();
    }
    column += size;
  }
  return true;
}

}  // namespace vins::estimator
