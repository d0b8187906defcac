#include "vins_estimator/health/imu_plausibility.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace vins::estimator {

void ImuPlausibility::Window::add(const ImuSample& sample) {
  if (count == 0) first = sample;
  ++count;
  const double rate = sample.angular_velocity.norm();
  acceleration_sum += sample.acceleration;
  acceleration_norm_sum += sample.acceleration.norm();
  rate_sum += rate;
  rate_max = std::max(rate_max, rate);
  acceleration_is_constant = acceleration_is_constant && sample.acceleration == first.acceleration;
  rate_is_constant = rate_is_constant && sample.angular_velocity == first.angular_velocity;
}

void ImuPlausibility::addImu(const ImuSample& sample) {
  constexpr int kEnough = 50;  // samples
  newest_imu_ = sample.stamp;
  ++samples_apart_;
  judgeClocks();
  if (!sample.isFinite()) return;
  const double age = window_.count > 0 ? toSeconds(sample.stamp - window_.first.stamp) : 0.0;
  if (age < 0.0) window_ = {};
  window_.add(sample);
  if (age < options_.window || window_.count < kEnough) return;
  judgeAccelerometer(sample.stamp);
  judgeGyroscope(sample.stamp);
  window_ = {};
}

void ImuPlausibility::addImage(Stamp stamp) {
  newest_image_ = stamp;
  ++images_apart_;
  judgeClocks();
}

void ImuPlausibility::judgeAccelerometer(Stamp now) {
  const double mean = window_.acceleration_norm_sum / window_.count;
  const Eigen::Vector3d direction = window_.acceleration_sum / window_.count;
  const std::vector<std::pair<std::string, double>> figures = {{"mean_norm", mean}};
  std::ostringstream text;
  text.precision(3);
  text << "the accelerometer's mean is " << mean << " where gravity is " << options_.gravity
       << " m/s^2";
  if (window_.acceleration_is_constant) {
    const std::string values = mean == 0.0 ? "exact zeros" : "the same value";
    report(now, "imu_accelerometer_silent",
           "the accelerometer gives " + values +
               " in every sample: does the driver fill linear_acceleration, or does it come on a "
               "topic of its own (accel_topic)?",
           figures);
  }
  if (mean == 0.0) return;
  const double in_g = mean / options_.gravity;
  if (mean > 0.85 && mean < 1.15) {
    report(now, "imu_accelerometer_units", text.str() + ": is it in g? Give m/s^2", figures);
  } else if (in_g < 0.6 || in_g > 3.0) {
    report(now, "imu_no_gravity",
           text.str() + ": does the driver remove gravity, or use another unit?", figures);
  } else if (options_.R_bc) {
    // At rest the specific force points up, and in an upright camera up is -y.
    const double up = -(options_.R_bc->inverse() * direction).y() / options_.gravity;
    if (up > -0.7) return;
    report(now, "imu_upside_down",
           "the accelerometer says that the camera is upside down; if it is not, the "
           "accelerometer's sign is reversed (at rest it must point up, +g) or T_bc is wrong",
           {{"up_in_g", up}});
  }
}

void ImuPlausibility::judgeGyroscope(Stamp now) {
  const double mean = window_.rate_sum / window_.count;
  if (window_.rate_is_constant) {
    const std::string values = mean == 0.0 ? "exact zeros" : "the same value";
    report(now, "imu_gyroscope_silent",
           "the gyroscope gives " + values +
               " in every sample: does the driver fill angular_velocity, or does it come on a "
               "topic of its own (imu_topic is then the gyroscope's, accel_topic the other's)?",
           {{"mean_rate", mean}});
  }
  if (mean < options_.max_mean_rate && window_.rate_max < options_.max_rate) return;
  std::ostringstream text;
  text.precision(3);
  text << "the gyroscope turns at " << mean << " rad/s on average and " << window_.rate_max
       << " rad/s at most, more than a camera can be turned: is it in deg/s? Give rad/s";
  report(now, "imu_gyroscope_units", text.str(),
         {{"mean_rate", mean}, {"max_rate", window_.rate_max}});
}

void ImuPlausibility::judgeClocks() {
  constexpr int kImages = 20, kSamples = 40;
  if (!newest_imu_ || !newest_image_) return;
  const double offset = toSeconds(*newest_image_ - *newest_imu_);
  if (std::abs(offset) <= options_.max_clock_offset) {
    images_apart_ = samples_apart_ = 0;
    return;
  }
  // Both must go on: a stream that has ended is behind, too.
  if (images_apart_ < kImages || samples_apart_ < kSamples) return;
  images_apart_ = samples_apart_ = 0;
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(3);
  text << "the clocks of camera and IMU are apart: the newest image has stamp "
       << toSeconds(*newest_image_) << " s, the newest IMU sample " << toSeconds(*newest_imu_)
       << " s, a difference of " << offset
       << " s; both drivers must stamp with one clock (header.stamp)";
  report(*newest_image_, "clocks_apart", text.str(), {{"image_minus_imu_s", offset}});
}

void ImuPlausibility::report(Stamp now, const char* code, std::string text,
                             std::vector<std::pair<std::string, double>> figures) {
  const auto last = reported_.find(code);
  const bool is_recent = last != reported_.end() && now >= last->second &&
                         toSeconds(now - last->second) < options_.event_interval;
  if (is_recent) return;
  reported_[code] = now;
  events_.push_back({now, Severity::kWarning, code, std::move(text), std::move(figures)});
}

}  // namespace vins::estimator
