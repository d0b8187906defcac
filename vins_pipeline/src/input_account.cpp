#include "vins_pipeline/input_account.h"

#include <algorithm>
#include <sstream>

#include "vins_core/input_error.h"

namespace vins::pipeline {

void InputAccount::addImu(Stamp stamp) { last_imu_ = std::max(stamp, last_imu_.value_or(stamp)); }

void InputAccount::addAcceleration(Stamp stamp) {
  last_acceleration_ = std::max(stamp, last_acceleration_.value_or(stamp));
}

void InputAccount::addImage(Stamp stamp) {
  ++accepted_;
  first_image_ = std::min(stamp, first_image_.value_or(stamp));
  last_image_ = std::max(stamp, last_image_.value_or(stamp));
}

Event InputAccount::refuse(Stamp stamp, const std::string& reason) {
  constexpr std::size_t kHopeless = 10;
  if (refused_ == 0) first_reason_ = reason;
  ++refused_;
  if (refused_ >= kHopeless) requireImages();
  return {stamp, Severity::kError, "image_refused", reason, {}};
}

void InputAccount::addEvents(const std::vector<Event>& events) {
  for (const Event& event : events) {
    const bool is_reason = event.code.rfind("init_", 0) == 0 || event.code.rfind("imu_", 0) == 0 ||
                           event.code == "clocks_apart";
    if (is_reason) reasons_[event.code] = event.text;
    const bool is_about_rig = event.code.rfind("rig_", 0) == 0;
    if (is_about_rig) rig_finding_ = event.code == "rig_agrees" ? "" : event.text;
  }
}

void InputAccount::requireImages() const {
  if (accepted_ == 0 && refused_ > 0) throw InputError(first_reason_);
}

std::optional<Stamp> InputAccount::imuEnd() const {
  constexpr Stamp kTolerance = 500'000'000;  // [ns]
  if (!last_imu_ || !last_image_) return std::nullopt;
  const Stamp end = std::min(*last_imu_, last_acceleration_.value_or(*last_imu_));
  if (*last_image_ <= end + kTolerance) return std::nullopt;
  // Clocks that are apart are another finding.
  if (*first_image_ > end + kTolerance) return std::nullopt;
  return end;
}

std::string InputAccount::problems(const RecordingSummary& recording) const {
  std::ostringstream text;
  if (!recording.damage.empty()) text << "damage        " << recording.damage << "\n";
  if (!recording.interruption.empty()) {
    text << "not closed    " << recording.interruption << "\n";
  }
  if (refused_ > 0) {
    text << "refused       " << refused_ << " of " << recording.images
         << " images (see image_refused in events.csv)\n";
  }
  if (const std::optional<Stamp> end = imuEnd()) {
    text << "IMU           ended at second " << toSeconds(*end - recording.begin)
         << ", before the images: from there on there is no odometry\n";
  }
  if (!rig_finding_.empty()) text << "rig           " << rig_finding_ << "\n";
  return text.str();
}

std::string InputAccount::waitingReasons() const {
  std::string text;
  for (const auto& [code, reason] : reasons_) text += "  " + code + ": " + reason + "\n";
  return text;
}

}  // namespace vins::pipeline
