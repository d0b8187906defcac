#include "vins_estimator/inertial/body_twist.h"

#include <algorithm>

#include "vins_core/so3.h"

namespace vins::estimator {

BodyTwist bodyTwist(const NavState& state, const Matrix15d& covariance,
                    const Eigen::Vector3d& angular_velocity_b, double angular_velocity_variance) {
  const Eigen::Matrix3d R_bw = state.T_wb.rotation.conjugate().toRotationMatrix();
  BodyTwist twist;
  twist.linear_b = R_bw * state.v_w;
  twist.angular_b = angular_velocity_b;
  // (R exp(dtheta))^T (v + dv) = v_b + v_b x dtheta + R^T dv; the rate has the bias's error,
  // negated.
  Eigen::Matrix<double, 6, 15> J = Eigen::Matrix<double, 6, 15>::Zero();
  J.block<3, 3>(0, kRotation) = so3::hat(twist.linear_b);
  J.block<3, 3>(0, kVelocity) = R_bw;
  J.block<3, 3>(3, kGyrBias) = -Eigen::Matrix3d::Identity();
  twist.covariance = J * covariance * J.transpose();
  twist.covariance.diagonal().tail<3>().array() += angular_velocity_variance;
  return twist;
}

double newestRateVariance(const std::vector<ImuSample>& samples, double period,
                          const ImuNoise& noise) {
  const double last = samples.size() < 2
                          ? period
                          : toSeconds(samples.back().stamp - samples[samples.size() - 2].stamp);
  const double share = std::min(1.0, last / period);
  const double averaging = share * share + (1.0 - share) * (1.0 - share);
  return averaging * noise.gyroscopeVariance(period);
}

}  // namespace vins::estimator
