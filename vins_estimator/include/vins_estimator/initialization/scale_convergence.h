#pragma once

#include <optional>

#include "vins_core/time.h"

namespace vins::estimator {

/// Schedules new solutions of a moving start whose scale is not well known yet. Odometry begins
/// with what is known; later motion tells more, but the window has linearized and marginalized at
/// the first scale. So the start is solved again, over all measurements that are left of it, at
/// growing intervals, and the window begins anew with each solution that knows the scale clearly
/// better (as C. Campos, J. Montiel, J. Tardos, "Inertial-only optimization for visual-inertial
/// initialization", ICRA 2020, refine scale and gravity 5 and 15 s after the start).
class ScaleConvergence {
 public:
  /// Relative deviation of the scale from which on it has converged.
  static constexpr double kConverged = 0.03;

  /// A start at `stamp` with this relative deviation of its scale.
  void begin(Stamp stamp, double scale_sigma);
  void clear() { scale_sigma_.reset(); }

  /// The relative deviation of the scale; nullopt where it has converged, or nobody waits for it.
  const std::optional<double>& scaleSigma() const { return scale_sigma_; }

  /// Returns whether the start should be solved again with the frame at `stamp`; if so the next
  /// time is planned. After ten seconds the scale is left to the window.
  bool isDue(Stamp stamp);

  /// Returns whether a new solution is to be taken: it knows the scale clearly better. The
  /// convergence goes on from it, or ends.
  bool take(double scale_sigma);

 private:
  std::optional<double> scale_sigma_;
  Stamp begin_ = 0;
  Stamp next_ = 0;
  double interval_ = 0.0;  ///< [s]
};

}  // namespace vins::estimator
