#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "camera_model/camera.h"
#include "vins_core/imu.h"
#include "vins_core/time.h"

namespace vins::feature_tracker {

/// R_ab of the body at `from` (a) and at `to` (b), by integrating the gyroscope: the rate between
/// two samples is their mean, before the first and after the last sample theirs. Biases are not
/// known here and stay in. Nothing where no finite sample lies between the two times, or they leave
/// a gap of more than `max_gap` [s].
std::optional<Eigen::Quaterniond> integrateGyroscope(const std::vector<ImuSample>& imu, Stamp from,
                                                     Stamp to, double max_gap = 0.03);

/// A camera's turn between two images: R_21 takes bearings of the first to the second.
struct CameraTurn {
  Eigen::Quaterniond R_21 = Eigen::Quaterniond::Identity();
  bool measured = false;  ///< by the gyroscope; else a guess
};

/// Tells how a camera turned between two images: by the gyroscope where its samples are there, else
/// as it did before.
class TurnPrediction {
 public:
  explicit TurnPrediction(const Eigen::Quaterniond& R_bc) : R_bc_(R_bc) {}

  /// Takes samples, in the order of time.
  void addSamples(const std::vector<ImuSample>& imu);

  CameraTurn predict(Stamp from, Stamp to) const;

  /// The turn as the images showed it; samples from before `to` are not needed any more.
  void learn(const Eigen::Quaterniond& R_21, Stamp from, Stamp to);

  void reset();

 private:
  Eigen::Quaterniond R_bc_;
  std::vector<ImuSample> samples_;
  Eigen::Vector3d last_rate_ = Eigen::Vector3d::Zero();  ///< of R_21, camera frame [rad/s]
};

/// Pixel of a point far away whose bearing was `bearing` before the camera turned by R_ba (b: the
/// camera now). Nothing where the camera cannot see it any more.
std::optional<Eigen::Vector2d> turnedPixel(const camera_model::Camera& camera,
                                           const Eigen::Vector3d& bearing,
                                           const Eigen::Quaterniond& R_ba);

/// Angle that a pixel spans about a unit bearing [rad/px]: 1 / sqrt(|det(J B)|), where J is the
/// Jacobian of the projection there and B an orthonormal basis of the bearing's tangent plane (the
/// root of the solid angle of a pixel). Nothing where the bearing cannot be projected.
std::optional<double> angularResolution(const camera_model::Camera& camera,
                                        const Eigen::Vector3d& bearing);

}  // namespace vins::feature_tracker
