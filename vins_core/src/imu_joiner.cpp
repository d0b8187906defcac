#include "vins_core/imu_joiner.h"

#include <algorithm>
#include <sstream>

#include "vins_core/option_check.h"

namespace vins {
namespace {

constexpr std::size_t kMaxReadings = 10000;  ///< of one sensor, whatever their stamps are
constexpr double kMaxLead = 10.0;            ///< of one sensor, kept while the other is silent [s]

}  // namespace

void ImuJoinerOptions::validate() const {
  requirePositive("IMU joiner", "max_interval", max_interval);
  requirePositive("IMU joiner", "silence", silence);
  requirePositive("IMU joiner", "max_jump", max_jump);
  requirePositive("IMU joiner", "event_interval", event_interval);
}

ImuJoiner::ImuJoiner(const ImuJoinerOptions& options) : options_(options) { options_.validate(); }

void ImuJoiner::addGyroscope(Stamp stamp, const Eigen::Vector3d& angular_velocity) {
  add({stamp, angular_velocity}, &gyroscope_, &newest_gyroscope_);
}

void ImuJoiner::addAccelerometer(Stamp stamp, const Eigen::Vector3d& acceleration) {
  add({stamp, acceleration}, &accelerometer_, &newest_accelerometer_);
}

void ImuJoiner::add(const Reading& reading, Readings* readings, std::optional<Stamp>* newest) {
  if (accept(reading, newest)) {
    readings->push_back(reading);
    *newest = reading.stamp;
    if (!first_stamp_) first_stamp_ = reading.stamp;
    while (readings->size() > kMaxReadings ||
           toSeconds(reading.stamp - readings->front().stamp) > kMaxLead) {
      readings->pop_front();
    }
    reportSilence();
  }
  reportDisorder(reading.stamp);
}

bool ImuJoiner::accept(const Reading& reading, std::optional<Stamp>* newest) {
  if (!reading.value.allFinite()) {
    ++not_finite_;
    return false;
  }
  if (!*newest) return true;
  if (toSeconds(reading.stamp - **newest) < -options_.max_jump) {
    jumpBack(reading.stamp);
    return true;
  }
  if (reading.stamp > **newest) return true;
  ++out_of_order_;
  return false;
}

void ImuJoiner::jumpBack(Stamp to) {
  // The other sensor may have jumped before: what it has of the new time stays.
  const Stamp latest = to + toNanoseconds(options_.max_jump);
  for (auto [readings, newest] : {std::pair(&gyroscope_, &newest_gyroscope_),
                                  std::pair(&accelerometer_, &newest_accelerometer_)}) {
    if (*newest && **newest <= latest) continue;
    readings->clear();
    newest->reset();
  }
  first_stamp_.reset();
}

std::optional<ImuSample> ImuJoiner::next() {
  while (!gyroscope_.empty()) {
    const Reading reading = gyroscope_.front();
    while (accelerometer_.size() > 1 && accelerometer_[1].stamp <= reading.stamp) {
      accelerometer_.pop_front();
    }
    const bool is_decided = newest_accelerometer_ && *newest_accelerometer_ >= reading.stamp;
    const double waited = toSeconds(gyroscope_.back().stamp - reading.stamp);
    if (!is_decided && waited <= options_.silence) return std::nullopt;
    gyroscope_.pop_front();
    if (!is_decided) continue;
    const std::optional<Eigen::Vector3d> acceleration = accelerationAt(reading.stamp);
    if (acceleration) return ImuSample{reading.stamp, *acceleration, reading.value};
  }
  return std::nullopt;
}

std::optional<Eigen::Vector3d> ImuJoiner::accelerationAt(Stamp stamp) const {
  const Reading& before = accelerometer_.front();
  if (before.stamp == stamp) return before.value;
  if (before.stamp > stamp) return std::nullopt;
  const Reading& after = accelerometer_[1];
  const double interval = toSeconds(after.stamp - before.stamp);
  if (interval > options_.max_interval) return std::nullopt;
  const double share = toSeconds(stamp - before.stamp) / interval;
  return before.value + share * (after.value - before.value);
}

void ImuJoiner::reportSilence() {
  const Stamp gyroscope = newest_gyroscope_.value_or(*first_stamp_);
  const Stamp accelerometer = newest_accelerometer_.value_or(*first_stamp_);
  const double silence = toSeconds(gyroscope - accelerometer);
  std::ostringstream text;
  if (silence > options_.silence && isDue(gyroscope, &accelerometer_reported_)) {
    text << "no accelerometer sample for " << silence
         << " s while the gyroscope goes on: is accel_topic right, is the accelerometer switched "
            "on, do both stamp with one clock?";
    report(gyroscope, "imu_accelerometer_missing", text.str(), {{"silence_s", silence}});
  } else if (-silence > options_.silence && isDue(accelerometer, &gyroscope_reported_)) {
    text << "no gyroscope sample for " << -silence
         << " s while the accelerometer goes on: is imu_topic right, is the gyroscope switched on, "
            "do both stamp with one clock?";
    report(accelerometer, "imu_gyroscope_missing", text.str(), {{"silence_s", -silence}});
  }
}

void ImuJoiner::reportDisorder(Stamp now) {
  if (not_finite_ + out_of_order_ == 0 || !isDue(now, &disorder_reported_)) return;
  std::ostringstream text;
  text << "samples of gyroscope or accelerometer dropped: " << not_finite_ << " not finite, "
       << out_of_order_ << " double or out of order";
  report(now, "imu_disorder", text.str(),
         {{"not_finite", not_finite_}, {"out_of_order", out_of_order_}});
  not_finite_ = out_of_order_ = 0;
}

bool ImuJoiner::isDue(Stamp now, std::optional<Stamp>* reported) const {
  const bool is_recent = *reported && now >= **reported - toNanoseconds(options_.max_jump) &&
                         toSeconds(now - **reported) < options_.event_interval;
  if (!is_recent) *reported = now;
  return !is_recent;
}

void ImuJoiner::report(Stamp now, const char* code, std::string text,
                       std::vector<std::pair<std::string, double>> figures) {
  events_.push_back({now, Severity::kWarning, code, std::move(text), std::move(figures)});
}

}  // namespace vins
