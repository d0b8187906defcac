#include "vins_estimator/initialization/joint_refinement.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/SparseCholesky>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "vins_core/option_check.h"
#include "vins_estimator/factors/imu_factor.h"
#include "vins_estimator/factors/parameter_blocks.h"
#include "vins_estimator/factors/prior_factor.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;

constexpr double kRobust = 1.5;  ///< residuals beyond it pull with constant force [deviations]

/// Position and yaw of the first state by convention, biases about zero.
Prior makePrior(const NavState& first, const JointRefinementOptions& options) {
  NavState unbiased = first;
  unbiased.accelerometer_bias.setZero();
  unbiased.gyroscope_bias.setZero();
  Prior prior;
  prior.parts = {{Prior::Kind::kPose, 0, first, {}, {}},
                 {Prior::Kind::kMotion, 0, unbiased, {}, {}}};
  prior.A = Eigen::MatrixXd::Zero(10, 15);
  prior.A.block<3, 3>(0, kPosition).diagonal().setConstant(1.0 / options.position_sigma);
  const Vector3d up_b = first.T_wb.rotation.conjugate() * Vector3d::UnitZ();
  prior.A.block<1, 3>(3, kRotation) = up_b.transpose() / options.yaw_sigma;
  prior.A.block<3, 3>(4, kAccBias).diagonal().setConstant(1.0 / options.accelerometer_bias_sigma);
  prior.A.block<3, 3>(7, kGyrBias).diagonal().setConstant(1.0 / options.gyroscope_bias_sigma);
  prior.b = Eigen::VectorXd::Zero(10);
  return prior;
}

/// The adjustment as Ceres sees it. Built anew for each solution, as outliers and integrations
/// change in between.
class Adjustment {
 public:
  Adjustment(const Prior& prior, JointProblem* joint);

  bool solve(int max_iterations);
  const InitialBlocks& blocks() const { return blocks_; }
  double imuSquares();

  /// Root-information-weighted Jacobian of all residuals, without the loss, by poses (6 each),
  /// motions (9 each), landmarks (3 each).
  std::optional<Eigen::SparseMatrix<double>> information();

 private:
  void addStates();
  void addImu(const std::vector<Preintegration>& imu, const Vector3d& g_w);

  JointProblem* joint_;
  InitialBlocks blocks_;
  ceres::HuberLoss loss_;
  PoseManifold manifold_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_;
  std::vector<ceres::ResidualBlockId> imu_residuals_;
  std::unique_ptr<ceres::Problem> problem_;
};

std::unique_ptr<ceres::Problem> emptyProblem() {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return std::make_unique<ceres::Problem>(options);
}

Adjustment::Adjustment(const Prior& prior, JointProblem* joint)
    : joint_(joint),
      blocks_(joint->states),
      loss_(kRobust),
      ordering_(std::make_shared<ceres::ParameterBlockOrdering>()),
      problem_(emptyProblem()) {
  addStates();
  problem_->AddResidualBlock(new PriorFactor(prior), nullptr, blocks_.poses.front().data(),
                             blocks_.motions.front().data());
  const double gravity = joint->imu.back().noise().gravity;
  addImu(joint->imu, Vector3d(0.0, 0.0, -gravity));
  addLandmarkResiduals(joint->T_bc, &loss_, &blocks_, &joint->landmarks, problem_.get(),
                       ordering_.get());
}

void Adjustment::addStates() {
  for (std::size_t i = 0; i < blocks_.poses.size(); ++i) {
    problem_->AddParameterBlock(blocks_.poses[i].data(), 7, &manifold_);
    problem_->AddParameterBlock(blocks_.motions[i].data(), 9);
    // Within a group Ceres goes by addresses: of two arrays, either may come first in memory.
    ordering_->AddElementToGroup(blocks_.poses[i].data(), 1);
    ordering_->AddElementToGroup(blocks_.motions[i].data(), 2);
  }
}

void Adjustment::addImu(const std::vector<Preintegration>& imu, const Vector3d& g_w) {
  for (std::size_t i = 1; i < imu.size(); ++i) {
    auto* factor = new ImuFactor(imu[i], g_w, blocks_.states[i - 1], blocks_.states[i]);
    imu_residuals_.push_back(problem_->AddResidualBlock(
        factor, nullptr, blocks_.poses[i - 1].data(), blocks_.motions[i - 1].data(),
        blocks_.poses[i].data(), blocks_.motions[i].data()));
  }
}

bool Adjustment::solve(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = ordering_;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem_.get(), &summary);
  joint_->states = blocks_.values();
  return summary.termination_type == ceres::CONVERGENCE;
}

double Adjustment::imuSquares() {
  ceres::Problem::EvaluateOptions options;
  options.residual_blocks = imu_residuals_;
  double cost = 0.0;
  problem_->Evaluate(options, &cost, nullptr, nullptr, nullptr);
  return 2.0 * cost;
}

std::optional<Eigen::SparseMatrix<double>> Adjustment::information() {
  ceres::Problem::EvaluateOptions options;
  options.apply_loss_function = false;
  for (PoseBlock& pose : blocks_.poses) options.parameter_blocks.push_back(pose.data());
  for (MotionBlock& motion : blocks_.motions) options.parameter_blocks.push_back(motion.data());
  for (InitialLandmark& landmark : joint_->landmarks) {
    options.parameter_blocks.push_back(landmark.parameters.data());
  }
  ceres::CRSMatrix crs;
  if (!problem_->Evaluate(options, nullptr, nullptr, nullptr, &crs)) return std::nullopt;
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> J(
      crs.num_rows, crs.num_cols, static_cast<int>(crs.values.size()), crs.rows.data(),
      crs.cols.data(), crs.values.data());
  return Eigen::SparseMatrix<double>(J.transpose() * J);
}

/// The linear form that takes errors of the positions to the relative error of the path's size: its
/// least-squares fit, to which rotations and shifts of the path do not contribute.
Eigen::VectorXd scaleForm(const std::vector<NavState>& states, Eigen::Index columns) {
  Vector3d centre = Vector3d::Zero();
  for (const NavState& state : states) centre += state.T_wb.position / states.size();
  Eigen::VectorXd form = Eigen::VectorXd::Zero(columns);
  double squares = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Vector3d arm = states[i].T_wb.position - centre;
    form.segment<3>(static_cast<Eigen::Index>(6 * i)) = arm;
    squares += arm.squaredNorm();
  }
  return form / std::max(squares, 1e-12);
}

/// Fills in scale_sigma and sigma. False where the information is singular.
bool findDeviations(const std::vector<NavState>& states, Adjustment* adjustment,
                    JointRefinement* result) {
  const auto information = adjustment->information();
  if (!information) return false;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(*information);
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0.0)) return false;
  const Eigen::VectorXd form = scaleForm(states, information->cols());
  result->scale_sigma = std::sqrt(form.dot(factor.solve(form)));
  const auto motions = static_cast<Eigen::Index>(6 * states.size());
  for (Eigen::Index i = 0; i < 15; ++i) {
    const Eigen::Index column = i < 6 ? i : motions + i - 6;
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(information->cols(), column);
    result->sigma(i) = std::sqrt(factor.solve(unit)(column));
  }
  return std::isfinite(result->scale_sigma) && result->sigma.allFinite();
}

}  // namespace

void JointRefinementOptions::validate() const {
  const std::pair<const char*, double> positive[] = {
      {"accelerometer_bias_sigma", accelerometer_bias_sigma},
      {"gyroscope_bias_sigma", gyroscope_bias_sigma},
      {"position_sigma", position_sigma},
      {"yaw_sigma", yaw_sigma},
      {"outlier_gate", outlier_gate},
      {"max_iterations", max_iterations}};
  for (const auto& [name, value] : positive) requirePositive("joint refinement", name, value);
}

JointRefinement refineJointly(const JointRefinementOptions& options, JointProblem* problem) {
  JointRefinement result;
  if (problem->states.size() < 2 || problem->landmarks.empty()) return result;
  const Prior prior = makePrior(problem->states.front(), options);
  {
    Adjustment first(prior, problem);
    first.solve(options.max_iterations);
    removeOutliers(options.outlier_gate, problem->T_bc, first.blocks(), &problem->landmarks);
  }
  const NavState& newest = problem->states.back();
  if (!isFinite(newest) || problem->landmarks.empty()) return result;
  for (Preintegration& imu : problem->imu) {
    imu.reintegrate(newest.accelerometer_bias, newest.gyroscope_bias);
  }
  Adjustment last(prior, problem);
  if (!last.solve(options.max_iterations)) return result;
  result.visual_rms = landmarkRms(problem->T_bc, last.blocks(), problem->landmarks);
  result.squares =
      last.imuSquares() + landmarkSquares(problem->T_bc, last.blocks(), problem->landmarks);
  result.converged = findDeviations(problem->states, &last, &result);
  return result;
}

}  // namespace vins::estimator
