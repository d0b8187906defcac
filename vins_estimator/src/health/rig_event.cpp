#include "rig_event.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace vins::estimator {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// How a part's error is put into words.
struct Wording {
  const char* code;
  const char* figure;     ///< name of its size, unit in the name
  const char* deviation;  ///< name of its deviation
  double unit;            ///< in RigErrorVector's units
};

Wording wordingOf(RigPart part) {
  switch (part) {
    case RigPart::kTranslation:
      return {"rig_translation", "translation_m", "deviation_m", 1.0};
    case RigPart::kRotation:
      return {"rig_rotation", "rotation_deg", "deviation_deg", kDegree};
    case RigPart::kTimeOffset:
      return {"rig_time_offset", "time_offset_ms", "deviation_ms", 1e-3};
    case RigPart::kReadout:
      return {"rig_readout", "readout_ms", "deviation_ms", 1e-3};
    case RigPart::kFocalLength:
      return {"rig_focal_length", "focal_length_percent", "deviation_percent", 1e-2};
  }
  return {"rig_unknown", "error", "deviation", 1.0};
}

/// Two digits are as much as is known.
std::string rounded(double value) {
  std::ostringstream text;
  text.precision(2);
  text << value;
  return text.str();
}

/// In hundredths.
std::string vectorText(const Eigen::VectorXd& v) {
  std::ostringstream text;
  for (int i = 0; i < 3; ++i) {
    const double value = std::round(100.0 * v(i)) / 100.0;
    text << (i == 0 ? "(" : ", ") << (value == 0.0 ? 0.0 : value);  // no -0
  }
  text << ")";
  return text.str();
}

/// "its x axis", or the axis itself where it is none of the three.
std::string axisText(const Eigen::VectorXd& rotation) {
  constexpr double kNear = 0.9;  // cosine of 25 degrees
  const Eigen::VectorXd axis = rotation.normalized();
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis(i)) < kNear) continue;
    return std::string("its ") + "xyz"[i] + " axis";
  }
  return "its axis " + vectorText(axis);
}

/// The finding and the advice; `least`: size in the wording's unit.
std::string describe(const RigExplanation& found, const std::string& least) {
  const bool is_more = found.error(0) > 0.0;
  switch (found.part) {
    case RigPart::kTranslation:
      return "the camera seems to stand at least " + least +
             " m from where extrinsicTranslation has it, about " + vectorText(found.error) +
             " m in the body frame; measure it again, or set estimate_extrinsic: 1";
    case RigPart::kRotation:
      return "the camera seems to be turned by at least " + least + " degrees about " +
             axisText(found.error) +
             " against extrinsicRotation; calibrate again, or set estimate_extrinsic: 1";
    case RigPart::kTimeOffset:
      return "the time offset td seems to be at least " + least + " ms " +
             (is_more ? "larger" : "smaller") + " than it is given; set estimate_td: 1";
    case RigPart::kReadout:
      return "the rows of an image seem to take at least " + least + " ms " +
             (is_more ? "more" : "less") +
             " to be read out than rolling_shutter_tr says; set it (with rolling_shutter: 1), or "
             "estimate_readout: 1";
    case RigPart::kFocalLength:
      return "the focal length seems to be at least " + least + " % " +
             (is_more ? "larger" : "smaller") +
             " than in projection_parameters; calibrate the camera again, or set "
             "estimate_intrinsics: 1";
  }
  return "";
}

}  // namespace

Event rigEvent(Stamp stamp, const RigExplanation& explanation, std::size_t windows) {
  const Wording wording = wordingOf(explanation.part);
  const double least = std::max(0.0, explanation.size - 2.0 * explanation.deviation);
  const bool is_vector = explanation.error.size() > 1;
  std::vector<std::pair<std::string, double>> figures = {
      {wording.figure, (is_vector ? explanation.size : explanation.error(0)) / wording.unit},
      {wording.deviation, explanation.deviation / wording.unit},
      {"share_of_cost_percent", 100.0 * explanation.share},
      {"windows", static_cast<double>(windows)}};
  const char* const names[] = {"x", "y", "z"};
  for (int i = 0; is_vector && i < 3; ++i) {
    figures.emplace_back(std::string(wording.figure) + "_" + names[i],
                         explanation.error(i) / wording.unit);
  }
  return {stamp, Severity::kWarning, wording.code,
          describe(explanation, rounded(least / wording.unit)), std::move(figures)};
}

Event rigAgreesEvent(Stamp stamp) {
  return {stamp,
          Severity::kInfo,
          "rig_agrees",
          "camera and IMU agree again with the rig as it is given; the last rig_ event is void",
          {}};
}

}  // namespace vins::estimator
