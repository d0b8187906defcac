#pragma once

namespace vins::pose_graph {

/// Shapes of the cost of an edge that may be wrong.
enum class KernelType { kNone, kHuber, kCauchy, kGemanMcClure };

/// Cost rho(s) of an edge by its squared whitened error s = r^T Omega r, scaled so that rho'(0) = 1
/// (Z. Zhang, "Parameter estimation techniques", 1997, table 1, with c the width).
struct RobustKernel {
  KernelType type = KernelType::kNone;
  double width = 1.0;  ///< whitened error from which on the kernel takes effect; no unit

  /// rho(s): c is the width. Huber: s up to c^2, then 2 c sqrt(s) - c^2. Cauchy: c^2 log(1 +
  /// s/c^2). Geman-McClure: c^2 s / (c^2 + s).
  double cost(double squared_error) const;

  /// rho'(s): the weight of the edge in iteratively reweighted least squares.
  double weight(double squared_error) const;

  /// Throws InputError where the width is not positive and finite.
  void validate() const;
};

}  // namespace vins::pose_graph
