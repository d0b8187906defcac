#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vins_core/imu.h"
#include "vins_estimator/inertial/imu_intrinsics.h"
#include "vins_estimator/inertial/nav_state.h"

namespace vins::estimator {

/// What the IMU says between two times i and j, free of the state at i: the increments of position
/// alpha, rotation gamma and velocity beta, in the body frame at i. Midpoint integration; error
/// states in the order of ErrorState. Equations: T. Qin, P. Li, S. Shen, "VINS-Mono: a robust and
/// versatile monocular visual-inertial state estimator", T-RO 2018, section IV-B; C. Forster et
/// al., "On-manifold preintegration for real-time visual-inertial odometry", T-RO 2017.
class Preintegration {
 public:
  /// Integrates with these biases [m/s^2], [rad/s] and errors of the axes until reintegrate() is
  /// given others.
  Preintegration(const ImuNoise& noise, const Eigen::Vector3d& accelerometer_bias,
                 const Eigen::Vector3d& gyroscope_bias,
                 const ImuIntrinsics& intrinsics = ImuIntrinsics::Zero());

  /// Carries on over neighbouring samples, which have rising stamps; the first must be the last one
  /// of the samples before (same stamp), or the very first. Where the samples show vibration, the
  /// accelerometer's noise is raised by ImuNoise::vibration_share of it; over a gap between two of
  /// them the noise is that of a motion that nobody saw. `at_rest`: that the body stands still is
  /// known better otherwise, and the accelerometer counts for little. It would measure gravity and
  /// its own bias for as long as the rest lasts, with a precision at which linearizations a tenth
  /// of a degree apart contradict each other: tilt and bias, which are not told apart at rest,
  /// would slide.
  void integrate(const std::vector<ImuSample>& samples, bool at_rest = false);

  /// Carries on over the samples of the interval that follows.
  void append(const Preintegration& next);

  /// Integrates all samples anew, with other biases.
  void reintegrate(const Eigen::Vector3d& accelerometer_bias,
                   const Eigen::Vector3d& gyroscope_bias);
  /// With other errors of the axes, too.
  void reintegrate(const Eigen::Vector3d& accelerometer_bias, const Eigen::Vector3d& gyroscope_bias,
                   const ImuIntrinsics& intrinsics);

  /// The first-order correction for these biases and errors of the axes is no longer good: their
  /// distance from those integrated with, times the interval or what was measured in it, would bend
  /// it by more than a small part of its noise.
  bool needsReintegration(const Eigen::Vector3d& accelerometer_bias,
                          const Eigen::Vector3d& gyroscope_bias,
                          const ImuIntrinsics& intrinsics) const;

  double duration() const { return duration_; }  ///< [s]
  bool empty() const { return pieces_.empty(); }
  const Eigen::Vector3d& alpha() const { return alpha_; }     ///< [m]
  const Eigen::Quaterniond& gamma() const { return gamma_; }  ///< R_bi_bj
  const Eigen::Vector3d& beta() const { return beta_; }       ///< [m/s]
  const Eigen::Vector3d& accelerometerBias() const { return accelerometer_bias_; }
  const Eigen::Vector3d& gyroscopeBias() const { return gyroscope_bias_; }
  const ImuIntrinsics& intrinsics() const { return intrinsics_; }
  const ImuNoise& noise() const { return noise_; }

  /// d(alpha, theta, beta, ba, bg) at j by the same at i: 15x15. Its blocks right of kVelocity are
  /// the derivatives by the biases.
  const Matrix15d& jacobian() const { return jacobian_; }
  /// d(alpha, theta, beta) at j by the errors of the axes.
  const Eigen::Matrix<double, 9, 15>& intrinsicsJacobian() const { return intrinsics_jacobian_; }
  /// Covariance of the increments' errors (alpha, theta, beta, ba, bg).
  const Matrix15d& covariance() const { return covariance_; }
  /// Whether the covariance can be inverted. False only where it is not finite.
  bool isWeightable() const;
  /// Lower triangular S with S^T S = (covariance() + F)^-1; F floors the deviations of very short
  /// intervals at some 1e-6 of a unit. Zero where the interval is not weightable. Computed when
  /// asked for the first time.
  const Matrix15d& sqrtInformation() const;

  struct Increments {
    Eigen::Vector3d alpha;
    Eigen::Quaterniond gamma;
    Eigen::Vector3d beta;
  };
  /// Corrected to first order for these biases and, where they are given, errors of the axes.
  Increments corrected(const Eigen::Vector3d& accelerometer_bias,
                       const Eigen::Vector3d& gyroscope_bias) const;
  Increments corrected(const Eigen::Vector3d& accelerometer_bias,
                       const Eigen::Vector3d& gyroscope_bias,
                       const ImuIntrinsics& intrinsics) const;

  /// The state at j of a body that stands at `state` at i. `g_w`: gravity, (0, 0, -g).
  NavState predict(const NavState& state, const Eigen::Vector3d& g_w) const;

  /// Variances of a step's mean readings, besides the sensor's noise: the motion between two
  /// samples is not known.
  struct MissedMotion {
    double acceleration = 0.0;  ///< [m^2/s^4]
    double turn_rate = 0.0;     ///< [rad^2/s^2]
  };

 private:
  /// Samples in a row.
  struct Piece {
    std::vector<ImuSample> samples;
    bool at_rest;
  };
  void computeSqrtInformation() const;
  void integratePiece(const Piece& piece);
  void bridge(const ImuSample& from, const ImuSample& to, const ImuNoise& noise);
  void step(const ImuSample& from, const ImuSample& to, const ImuNoise& noise,
            const MissedMotion& missed);

  ImuNoise noise_;
  Eigen::Vector3d accelerometer_bias_;
  Eigen::Vector3d gyroscope_bias_;
  ImuIntrinsics intrinsics_;
  std::vector<Piece> pieces_;

  double duration_ = 0.0;
  Eigen::Vector3d alpha_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond gamma_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d beta_ = Eigen::Vector3d::Zero();
  Matrix15d jacobian_ = Matrix15d::Identity();
  Eigen::Matrix<double, 9, 15> intrinsics_jacobian_ = Eigen::Matrix<double, 9, 15>::Zero();
  Matrix15d covariance_ = Matrix15d::Zero();
  mutable Matrix15d sqrt_information_;
  mutable bool sqrt_information_known_ = false;
  mutable bool is_weightable_ = false;
};

}  // namespace vins::estimator
