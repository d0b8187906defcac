#include "calibration_problem.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <ceres/ceres.h>

#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::camera_model {
namespace {

/// A board's pose as six numbers: rotation vector [rad], then position.
using PoseBlock = std::array<double, 6>;

PoseBlock toBlock(const Pose& T_cb) {
  const Eigen::Vector3d phi = so3::log(T_cb.rotation);
  const Eigen::Vector3d& p = T_cb.position;
  return {phi.x(), phi.y(), phi.z(), p.x(), p.y(), p.z()};
}

Pose toPose(const double* block) {
  return {so3::exp(Eigen::Vector3d(block)), Eigen::Vector3d(block + 3)};
}

/// The camera at the parameters that Ceres is about to evaluate, made once for all corners.
class CurrentCamera : public ceres::EvaluationCallback {
 public:
  CurrentCamera(const Camera& prototype, const CameraParameters* parameters)
      : prototype_(prototype), parameters_(parameters) {}

  void PrepareForEvaluation(bool /*evaluate_jacobians*/, bool is_new_point) override {
    if (!is_new_point && camera_) return;
    try {
      camera_ = prototype_.withParameters(*parameters_);
    } catch (const InputError&) {
      camera_.reset();  // a step out of the allowed parameters: Ceres takes a shorter one
    }
  }

  const Camera* get() const { return camera_.get(); }

 private:
  const Camera& prototype_;
  const CameraParameters* parameters_;
  std::unique_ptr<Camera> camera_;
};

/// Projected minus detected corner [px], by the camera's parameters and the board's pose.
class CornerCost : public ceres::CostFunction {
 public:
  CornerCost(const CurrentCamera* camera, int parameter_count, const Eigen::Vector3d& point_b,
             const Eigen::Vector2d& corner)
      : camera_(camera), point_b_(point_b), corner_(corner) {
    set_num_residuals(2);
    mutable_parameter_block_sizes()->push_back(parameter_count);
    mutable_parameter_block_sizes()->push_back(6);
  }

  bool Evaluate(double const* const* blocks, double* residual, double** jacobians) const override {
    if (camera_->get() == nullptr) return false;
    const Pose T_cb = toPose(blocks[1]);
    ProjectionJacobians J;
    const auto pixel = camera_->get()->project(T_cb * point_b_, jacobians ? &J : nullptr);
    if (!pixel) return false;
    Eigen::Map<Eigen::Vector2d>{residual} = *pixel - corner_;
    if (jacobians == nullptr) return true;
    using Jacobian = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor>;
    if (jacobians[0] != nullptr) {
      Eigen::Map<Jacobian>(jacobians[0], 2, parameter_block_sizes()[0]) = J.J_pixel_parameters;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 6, Eigen::RowMajor>> J_pose(jacobians[1]);
      const Eigen::Matrix3d J_point_phi = -T_cb.rotation.toRotationMatrix() * so3::hat(point_b_) *
                                          so3::rightJacobian(Eigen::Vector3d(blocks[1]));
      J_pose << J.J_pixel_point * J_point_phi, J.J_pixel_point;
    }
    return true;
  }

 private:
  const CurrentCamera* camera_;
  Eigen::Vector3d point_b_;
  Eigen::Vector2d corner_;
};

/// Parameters that no view can tell, or that the user wants to be zero.
std::vector<int> heldParameters(CameraModel model, bool estimate_k3) {
  if (model == CameraModel::kPinhole && !estimate_k3) return {8};
  // p1 is zero for every mirror and lens (Scaramuzza et al. 2006); a turn of the sensor about the
  // axis, which ad and ae share, is a turn of all boards.
  if (model == CameraModel::kScaramuzza) return {1, 7};
  return {};
}

/// A Ceres problem over the state's parameters and poses, and all that it points to.
class CalibrationProblem {
 public:
  CalibrationProblem(const std::vector<Eigen::Vector3d>& points,
                     const std::vector<CalibrationView>& views, const CornerMask& mask,
                     const AdjustmentOptions& options, const CalibrationState& state)
      : parameters_(state.camera->parameters()),
        blocks_(views.size()),
        current_(*state.camera, &parameters_),
        problem_(problemOptions(&current_)) {
    const int count = static_cast<int>(parameters_.size());
    problem_.AddParameterBlock(parameters_.data(), count);
    const std::vector<int> held = heldParameters(state.camera->model(), options.estimate_k3);
    if (!held.empty()) {
      problem_.SetManifold(parameters_.data(), new ceres::SubsetManifold(count, held));
    }
    boundParameters(state.camera->model());
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (state.poses[i]) addView(points, views[i], mask[i], options, *state.poses[i], i);
    }
  }

  /// Within these a model is defined.
  void boundParameters(CameraModel model) {
    const auto bound = [&](int index, double least, double most) {
      problem_.SetParameterLowerBound(parameters_.data(), index, least);
      problem_.SetParameterUpperBound(parameters_.data(), index, most);
    };
    constexpr double kMost = 1e6;
    if (model == CameraModel::kMei) bound(0, 0.0, kMost);  // xi
    if (model == CameraModel::kDoubleSphere) {
      bound(0, -1.0, 1.0);  // xi
      bound(1, 0.0, 1.0);   // alpha
    }
    if (model == CameraModel::kEucm) {
      bound(0, 0.0, 1.0);     // alpha
      bound(1, 1e-3, kMost);  // beta
    }
  }

  bool solve(int max_iterations) {
    ceres::Solver::Options options;
    options.max_num_iterations = max_iterations;
    options.linear_solver_type = ceres::SPARSE_SCHUR;
    options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    options.linear_solver_ordering->AddElementToGroup(parameters_.data(), 1);
    for (PoseBlock& block : blocks_) {
      if (problem_.HasParameterBlock(block.data())) {
        options.linear_solver_ordering->AddElementToGroup(block.data(), 0);
      }
    }
    options.function_tolerance = 1e-12;
    options.parameter_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    return summary.IsSolutionUsable();
  }

  void store(CalibrationState* state) const {
    state->camera = state->camera->withParameters(parameters_);
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      if (state->poses[i]) state->poses[i] = toPose(blocks_[i].data());
    }
  }

  /// Information of the camera's parameters with the poses eliminated (Schur complement).
  std::optional<Eigen::MatrixXd> parameterInformation() {
    const auto size = parameters_.size();
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
    for (PoseBlock& block : blocks_) {
      if (!problem_.HasParameterBlock(block.data())) continue;
      const std::optional<Eigen::MatrixXd> J = viewJacobian(block.data());
      if (!J) return std::nullopt;
      const Eigen::MatrixXd H = J->transpose() * *J;
      const Eigen::MatrixXd H_cp = H.topRightCorner(size, 6);
      information += H.topLeftCorner(size, size) -
                     H_cp * H.bottomRightCorner(6, 6).ldlt().solve(H_cp.transpose());
    }
    return information;
  }

 private:
  static ceres::Problem::Options problemOptions(ceres::EvaluationCallback* callback) {
    ceres::Problem::Options options;
    options.evaluation_callback = callback;
    return options;
  }

  void addView(const std::vector<Eigen::Vector3d>& points, const CalibrationView& view,
               const std::vector<bool>& mask, const AdjustmentOptions& options, const Pose& T_cb,
               std::size_t index) {
    blocks_[index] = toBlock(T_cb);
    const int count = static_cast<int>(parameters_.size());
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (!mask[j]) continue;
      ceres::LossFunction* loss =
          options.robust_scale > 0.0 ? new ceres::CauchyLoss(options.robust_scale) : nullptr;
      problem_.AddResidualBlock(new CornerCost(&current_, count, points[j], view.corners[j]), loss,
                                parameters_.data(), blocks_[index].data());
    }
  }

  /// Jacobian of a view's corners by the camera's parameters and the view's pose, in that order.
  std::optional<Eigen::MatrixXd> viewJacobian(const double* block) {
    std::vector<ceres::ResidualBlockId> residuals;
    problem_.GetResidualBlocksForParameterBlock(block, &residuals);
    const int count = static_cast<int>(parameters_.size());
    Eigen::MatrixXd J(2 * residuals.size(), count + 6);
    current_.PrepareForEvaluation(true, true);
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      using Jacobian = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor>;
      Jacobian J_camera(2, count), J_pose(2, 6);
      Eigen::Vector2d residual;
      const double* parameter_blocks[] = {parameters_.data(), block};
      double* jacobians[] = {J_camera.data(), J_pose.data()};
      if (!problem_.GetCostFunctionForResidualBlock(residuals[i])
               ->Evaluate(parameter_blocks, residual.data(), jacobians)) {
        return std::nullopt;
      }
      J.middleRows<2>(2 * i) << J_camera, J_pose;
    }
    return J;
  }

  CameraParameters parameters_;
  std::vector<PoseBlock> blocks_;
  CurrentCamera current_;
  ceres::Problem problem_;
};

}  // namespace

bool adjust(const std::vector<Eigen::Vector3d>& board_points,
            const std::vector<CalibrationView>& views, const CornerMask& mask,
            const AdjustmentOptions& options, CalibrationState* state) {
  CalibrationProblem problem(board_points, views, mask, options, *state);
  if (!problem.solve(options.max_iterations)) return false;
  problem.store(state);
  return true;
}

std::optional<Eigen::MatrixXd> parameterCovariance(const std::vector<Eigen::Vector3d>& board_points,
                                                   const std::vector<CalibrationView>& views,
                                                   const CornerMask& mask, bool estimate_k3,
                                                   const CalibrationState& state) {
  AdjustmentOptions options;
  options.estimate_k3 = estimate_k3;
  CalibrationProblem problem(board_points, views, mask, options, state);
  const std::optional<Eigen::MatrixXd> information = problem.parameterInformation();
  if (!information) return std::nullopt;
  const std::vector<int> held = heldParameters(state.camera->model(), estimate_k3);
  std::vector<int> free;
  for (int i = 0; i < information->rows(); ++i) {
    if (std::find(held.begin(), held.end(), i) == held.end()) free.push_back(i);
  }
  // Parameters of very different units: the diagonal is scaled to one before it is judged.
  const Eigen::MatrixXd reduced = (*information)(free, free);
  const Eigen::VectorXd scale = reduced.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * reduced * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
  if (!(solver.eigenvalues().minCoeff() > 1e-12)) return std::nullopt;
  const Eigen::MatrixXd inverse = solver.eigenvectors() *
                                  solver.eigenvalues().cwiseInverse().asDiagonal() *
                                  solver.eigenvectors().transpose();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(information->rows(), information->cols());
  covariance(free, free) = scale.asDiagonal() * inverse * scale.asDiagonal();
  return covariance;
}

std::vector<Eigen::Vector2d> cornerResiduals(const Camera& camera, const Pose& T_cb,
                                             const std::vector<Eigen::Vector3d>& board_points,
                                             const CalibrationView& view) {
  std::vector<Eigen::Vector2d> residuals;
  for (std::size_t j = 0; j < board_points.size(); ++j) {
    const auto pixel = camera.project(T_cb * board_points[j]);
    residuals.push_back(pixel ? Eigen::Vector2d(*pixel - view.corners[j])
                              : Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()));
  }
  return residuals;
}

}  // namespace vins::camera_model
