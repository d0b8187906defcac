#include "vins_estimator/health/failure_detector.h"

#include <cmath>
#include <string>
#include <vector>

#include "vins_core/option_check.h"
#include "vins_core/so3.h"

namespace vins::estimator {

void FailureDetectorOptions::validate() const {
  const std::vector<std::pair<const char*, double>> values = {
      {"max_accelerometer_bias", max_accelerometer_bias},
      {"max_gyroscope_bias", max_gyroscope_bias},
      {"max_speed", max_speed},
      {"max_jump", max_jump},
      {"max_turn", max_turn},
      {"max_velocity_sigma", max_velocity_sigma}};
  for (const auto& [name, value] : values) requirePositive("failure detector", name, value);
}

std::optional<Failure> detectFailure(const FailureDetectorOptions& options,
                                     const NavState& predicted, const NavState& solved,
                                     const Matrix15d& covariance) {
  if (!isFinite(solved)) return Failure{"the state is not finite", "finite", 0.0};
  const Vector15d d = minus(solved, predicted);
  const double sigma =
      std::sqrt(covariance.block<3, 3>(kVelocity, kVelocity).diagonal().maxCoeff());
  const struct {
    Failure failure;
    double allowed;
  } checks[] = {
      {{"the accelerometer's bias is too large", "bias_m_s2", solved.accelerometer_bias.norm()},
       options.max_accelerometer_bias},
      {{"the gyroscope's bias is too large", "bias_rad_s", solved.gyroscope_bias.norm()},
       options.max_gyroscope_bias},
      {{"the speed is too high", "speed_m_s", solved.v_w.norm()}, options.max_speed},
      {{"the position has jumped", "jump_m", d.segment<3>(kPosition).norm()}, options.max_jump},
      {{"the attitude has jumped", "turn_rad", d.segment<3>(kRotation).norm()}, options.max_turn},
      {{"the velocity is no longer known", "sigma_m_s", sigma}, options.max_velocity_sigma},
  };
  for (const auto& check : checks) {
    if (!(check.failure.value <= check.allowed)) return check.failure;
  }
  return std::nullopt;
}

}  // namespace vins::estimator
