#pragma once

#include <vector>

#include <Eigen/Core>

#include "vins_core/imu.h"
#include "vins_core/pose.h"
#include "vins_estimator/inertial/nav_state.h"

namespace vins::estimator {

/// Velocity and angular rate of the body along its own axes.
struct BodyTwist {
  Eigen::Vector3d linear_b = Eigen::Vector3d::Zero();   ///< [m/s]
  Eigen::Vector3d angular_b = Eigen::Vector3d::Zero();  ///< [rad/s]
  se3::Matrix6d covariance = se3::Matrix6d::Zero();     ///< linear first, then angular
};

/// The twist of a state whose errors have `covariance`, by ErrorState. `angular_velocity_b` is a
/// gyroscope's reading without the state's bias [rad/s], `angular_velocity_variance` that of the
/// white noise in it, per axis [rad^2/s^2]. The velocity v_b = R_wb^T v_w is as uncertain as v_w
/// and R_wb together make it, the rate as the reading and the bias do.
BodyTwist bodyTwist(const NavState& state, const Matrix15d& covariance,
                    const Eigen::Vector3d& angular_velocity_b, double angular_velocity_variance);

/// Variance of the white noise in the last of an interval's gyroscope readings, per axis
/// [rad^2/s^2]. Where that was interpolated between two samples, `period` [s] apart, the noise of
/// both is averaged in it.
double newestRateVariance(const std::vector<ImuSample>& samples, double period,
                          const ImuNoise& noise);

}  // namespace vins::estimator
