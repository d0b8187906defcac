#include "vins_estimator/initialization/waiting_reason.h"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <unordered_set>

#include "vins_core/time.h"

namespace vins::estimator {
namespace {

constexpr int kFewFeatures = 40;        ///< fewer are too few for a start
constexpr double kLasting = 0.6;        ///< a smaller share is lost from image to image
constexpr double kFastTurn = 1.5;       ///< blurs images and empties the view [rad/s]
constexpr double kTurnBeyond = 4.0;     ///< no hand or vehicle keeps it up [rad/s]
constexpr double kNoTurn = 1e-4;        ///< below every gyroscope's noise [rad/s]
constexpr double kRareImages = 0.12;    ///< [s]
constexpr double kRareSamples = 0.021;  ///< below 48 Hz [s]

const char* codeOf(StructureStatus status) {
  switch (status) {
    case StructureStatus::kFewTracks:
    case StructureStatus::kLostFrame:
      return "init_few_tracks";
    case StructureStatus::kLittleParallax:
      return "init_little_parallax";
    default:
      return "init_inconsistent";
  }
}

std::string rounded(double value) {
  std::ostringstream text;
  text.precision(2);
  text << value;
  return text.str();
}

/// What is odd about a gyroscope that images contradict; empty where nothing is.
std::string suspectGyroscope(const InputFigures& inputs) {
  if (inputs.turn_rate > kTurnBeyond) {
    return "which is " + rounded(inputs.turn_rate) +
           " rad/s on average: is it in deg/s? Give rad/s";
  }
  if (inputs.turn_rate < kNoTurn) {
    return "which is no turn at all: does the driver fill angular_velocity?";
  }
  return "";
}

/// Why features do not last from one image to the next.
std::string textOfShortTracks(const InputFigures& inputs) {
  const std::string found = "waiting: features do not last: only " +
                            std::to_string(static_cast<int>(100.0 * inputs.lasting)) +
                            " % of them are found again in the next image";
  const std::string rate = rounded(inputs.turn_rate) + " rad/s";
  if (inputs.turn_rate > kFastTurn) {
    return found + ", and the gyroscope turns at " + rate +
           ": turn more slowly; if the camera does not turn so fast, the gyroscope is not in rad/s";
  }
  if (inputs.image_period > kRareImages) {
    return found + ", and images come only every " + rounded(inputs.image_period) +
           " s: raise the camera's rate to 15 Hz or more";
  }
  return found + ", though the gyroscope turns at only " + rate +
         ": are images blurred (shorten the exposure) or repeated, does most of the scene move, "
         "is the extrinsic rotation right?";
}

std::string textOfFewTracks(const InputFigures& inputs) {
  if (inputs.features < kFewFeatures) {
    return "waiting: too few features in the images, " + std::to_string(inputs.features) +
           ": is the lens free and in focus, is there light? Show the camera a textured scene";
  }
  if (inputs.lasting < kLasting) return textOfShortTracks(inputs);
  const std::string found = "waiting: features leave the view too soon";
  const std::string suspect = suspectGyroscope(inputs);
  if (!suspect.empty()) return found + "; odd is the gyroscope's rate, " + suspect;
  if (inputs.turn_rate > 0.5) {
    return found + ", and the gyroscope turns at " + rounded(inputs.turn_rate) +
           " rad/s: move sideways with less turning";
  }
  return found + ": move more slowly, or farther from the scene";
}

std::string textOfInconsistency(const InputFigures& inputs) {
  const std::string found =
      "waiting: the images fit no rigid scene that turns as the gyroscope says";
  const std::string suspect = suspectGyroscope(inputs);
  if (!suspect.empty()) return found + ", " + suspect;
  if (inputs.imu_period > kRareSamples) {
    return found + ", and IMU samples come only every " + rounded(inputs.imu_period) +
           " s: raise the IMU's rate to 100 Hz or more";
  }
  return found + "; check T_bc, td and the intrinsics, avoid moving objects";
}

std::string textOf(StructureStatus status, const InputFigures& inputs) {
  switch (status) {
    case StructureStatus::kFewTracks:
    case StructureStatus::kLostFrame:
      return textOfFewTracks(inputs);
    case StructureStatus::kLittleParallax:
      return "waiting: the scene shows too little parallax; move sideways, rotation does not help";
    default:
      return textOfInconsistency(inputs);
  }
}

std::string textOfGravity(double gravity) {
  const std::string found =
      "waiting: what remains of the acceleration is " + rounded(gravity) + " m/s^2 and no gravity";
  if (gravity > 0.85 && gravity < 1.15) return found + ": is it in g? Give m/s^2";
  if (gravity < 5.0) {
    return found + ": does the driver take gravity away, or not fill linear_acceleration?";
  }
  return found + "; check g_norm, T_bc and td, or move more";
}

std::string textOfDisagreement(const InputFigures& inputs) {
  const std::string suspect = suspectGyroscope(inputs);
  if (suspect.empty()) {
    return "waiting: images and gyroscope turn differently; check T_bc, td and the intrinsics";
  }
  return "waiting: images do not turn as the gyroscope says, " + suspect;
}

std::string textOf(const Alignment& alignment, const InputFigures& inputs) {
  switch (alignment.status) {
    case AlignmentStatus::kLittleExcitation:
      return "waiting: too little acceleration to tell the scale; move with changes of speed and "
             "direction";
    case AlignmentStatus::kGyroscopeDisagrees:
      return textOfDisagreement(inputs);
    case AlignmentStatus::kGravityImplausible:
      return textOfGravity(alignment.gravity);
    case AlignmentStatus::kImplausible:
      return "waiting: the solution has a speed or biases beyond reason; check the IMU's units";
    default:
      return "waiting: structure and IMU contradict each other; check T_bc, td and noise, or move "
             "more";
  }
}

/// Ids of the first camera's features.
std::unordered_set<std::int64_t> featuresOf(const FrameMeasurements& measurements) {
  std::unordered_set<std::int64_t> ids;
  for (const FeatureObservation& observation : measurements.frame.observations) {
    if (observation.camera == 0) ids.insert(observation.id);
  }
  return ids;
}

/// Share of a frame's features that the next one has; 1 where it has none.
double shareLasting(const FrameMeasurements& frame, const FrameMeasurements& next) {
  const auto before = featuresOf(frame), after = featuresOf(next);
  if (before.empty()) return 1.0;
  const auto lasts = [&](std::int64_t id) { return after.count(id) > 0; };
  return static_cast<double>(std::count_if(before.begin(), before.end(), lasts)) /
         static_cast<double>(before.size());
}

std::vector<std::pair<std::string, double>> figuresFor(const InputFigures& inputs) {
  return {{"features", inputs.features},
          {"lasting_percent", 100.0 * inputs.lasting},
          {"turn_rate_rad_s", inputs.turn_rate}};
}

}  // namespace

InputFigures figuresOf(const std::deque<SharedMeasurements>& measurements) {
  InputFigures figures;
  if (measurements.empty()) return figures;
  figures.features = static_cast<int>(featuresOf(*measurements.back()).size());
  std::vector<double> gaps;
  double rates = 0.0, lasting = 0.0;
  std::size_t samples = 0;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    gaps.push_back(measurements[i]->longest_gap);
    for (const ImuSample& sample : measurements[i]->imu) rates += sample.angular_velocity.norm();
    samples += measurements[i]->imu.size();
    if (i > 0) lasting += shareLasting(*measurements[i - 1], *measurements[i]);
  }
  if (samples > 0) figures.turn_rate = rates / static_cast<double>(samples);
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  figures.imu_period = *middle;
  if (measurements.size() < 2) return figures;
  const auto intervals = static_cast<double>(measurements.size() - 1);
  figures.lasting = lasting / intervals;
  figures.image_period =
      toSeconds(measurements.back()->frame.stamp - measurements.front()->frame.stamp) / intervals;
  return figures;
}

WaitingReason explainFewTracks(const InputFigures& inputs) {
  return {codeOf(StructureStatus::kFewTracks), textOfFewTracks(inputs), figuresFor(inputs)};
}

WaitingReason explain(const VisualStructure& structure, const InputFigures& inputs) {
  WaitingReason reason = {
      codeOf(structure.status),
      textOf(structure.status, inputs) + " (" + toString(structure.status) + ")",
      {{"shared_features", structure.shared},
       {"parallax_px", structure.parallax},
       {"parallax_beyond_rotation_px", structure.own_parallax},
       {"visual_rms_sigma", structure.rms}}};
  const auto more = figuresFor(inputs);
  reason.figures.insert(reason.figures.end(), more.begin(), more.end());
  return reason;
}

WaitingReason explain(const Alignment& alignment, const InputFigures& inputs) {
  const bool little = alignment.status == AlignmentStatus::kLittleExcitation;
  std::string text = textOf(alignment, inputs);
  if (!little && inputs.imu_period > kRareSamples) {
    text += "; IMU samples come only every " + rounded(inputs.imu_period) +
            " s: raise the IMU's rate to 100 Hz or more";
  }
  return {little ? "init_little_excitation" : "init_inconsistent",
          text + " (" + toString(alignment.status) + ")",
          {{"scale_sigma_percent", 100.0 * alignment.scale_sigma},
           {"gravity_m_s2", alignment.gravity},
           {"visual_rms_sigma", alignment.visual_rms},
           {"imu_chi2_per_dof", alignment.imu_chi2}}};
}

}  // namespace vins::estimator
