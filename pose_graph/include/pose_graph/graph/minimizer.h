#pragma once

#include <functional>

#include <Eigen/Core>

namespace vins::pose_graph {

/// How a step is made of the normal equations.
enum class MinimizerMethod { kGaussNewton, kLevenbergMarquardt, kDogleg };

/// A least-squares problem with cost F(x) = 1/2 sum of rho(r^T r), as minimize() sees it: a current
/// estimate, a linearization there, and one trial beside it.
class LeastSquaresProblem {
 public:
  virtual ~LeastSquaresProblem() = default;

  /// Fills the normal equations at the current estimate; returns the cost there.
  virtual double linearize() = 0;

  /// Gradient g = J^T r and diagonal of H = J^T J of the last linearization.
  virtual const Eigen::VectorXd& gradient() const = 0;
  virtual Eigen::VectorXd diagonal() const = 0;

  /// x^T H x.
  virtual double curvature(const Eigen::VectorXd& x) const = 0;

  /// step = -(H + damping diag(H))^-1 g. False where there is no Cholesky factor.
  virtual bool solve(double damping, Eigen::VectorXd* step) = 0;

  /// Makes the trial, estimate [+] step, and returns its cost.
  virtual double tryStep(const Eigen::VectorXd& step) = 0;

  /// The trial becomes the current estimate.
  virtual void acceptTrial() = 0;
};

/// One iteration: what its step cost and gave.
struct IterationReport {
  int iteration = 0;         ///< from 1 on; 0 is the start
  double cost = 0.0;         ///< of the estimate after it
  double step_length = 0.0;  ///< norm of the step, metres and radians together
  double restraint = 0.0;    ///< damping (Levenberg-Marquardt) or trust radius (dogleg)
  bool accepted = true;      ///< false: the step would have raised the cost
};

/// What minimize() goes by.
struct MinimizerOptions {
  MinimizerMethod method = MinimizerMethod::kLevenbergMarquardt;
  int max_iterations = 100;
  double cost_tolerance = 1e-10;  ///< ends when a step promises less than this share of the cost
  double initial_damping = 1e-6;  ///< Levenberg-Marquardt's first, share of H's diagonal
  double cost_floor = 1e-16;      ///< or less than this: rounding, where errors are whitened
  std::function<void(const IterationReport&)> on_iteration;  ///< called after each, if set

  /// Throws InputError naming the option that is out of range.
  void validate() const;
};

/// How a minimization ended.
enum class MinimizerStatus {
  kConverged,
  kOutOfIterations,
  kFailed,  ///< no Cholesky factor, or a cost that is no finite number
};

struct MinimizerSummary {
  MinimizerStatus status = MinimizerStatus::kConverged;
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
};

/// Minimizes by full Gauss-Newton steps (which may raise the cost on their way), by
/// Levenberg-Marquardt with Nielsen's damping, or by Powell's dogleg in variables scaled by H's
/// diagonal (K. Madsen, H. B. Nielsen, O. Tingleff, "Methods for non-linear least squares
/// problems", 2004, sections 3.1 to 3.3). One thread, the same result on every run.
MinimizerSummary minimize(LeastSquaresProblem* problem, const MinimizerOptions& options);

}  // namespace vins::pose_graph
