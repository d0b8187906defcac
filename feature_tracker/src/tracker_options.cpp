#include "feature_tracker/tracker_options.h"

#include <cmath>

#include "vins_core/option_check.h"

namespace vins::feature_tracker {
namespace {

constexpr Range kMaxFeatures{1, 5000};
constexpr Range kMinDistance{1, 1000};
constexpr Range kFrequency{0, 1000};
constexpr Range kThreshold{0.05, 100};
constexpr Range kBorder{0, 1000};
constexpr Range kQuality{0.01, 255};
constexpr Range kWindow{7, 63};
constexpr Range kLevels{1, 8};
constexpr Range kBackward{0.01, 10};
constexpr Range kMaxGap{0.01, 100};
constexpr Range kMinTracks{0, 5000};
constexpr Range kSeed{0, 2147483647};

}  // namespace

void FeatureTrackerOptions::validate() const {
  requireWithin("feature tracker", "max_cnt", max_features, kMaxFeatures);
  requireWithin("feature tracker", "min_dist", min_distance, kMinDistance);
  requireWithin("feature tracker", "freq", frequency, kFrequency);
  requireWithin("feature tracker", "F_threshold", rejection_threshold, kThreshold);
  requireWithin("feature tracker", "feature_border", border, kBorder);
  requireWithin("feature tracker", "corner_quality", corner_quality, kQuality);
  requireWithin("feature tracker", "klt_window", window, kWindow);
  requireWithin("feature tracker", "klt_levels", pyramid_levels, kLevels);
  requireWithin("feature tracker", "klt_backward", backward_tolerance, kBackward);
  requireWithin("feature tracker", "max_image_gap", max_gap, kMaxGap);
  requireWithin("feature tracker", "min_tracks", min_tracks, kMinTracks);
}

std::ostream& operator<<(std::ostream& out, const FeatureTrackerOptions& options) {
  return out << "max_cnt: " << options.max_features << "\n"
             << "min_dist: " << options.min_distance << " px\n"
             << "freq: " << options.frequency << " Hz\n"
             << "F_threshold: " << options.rejection_threshold << " px\n"
             << "equalize: " << (options.equalization == Equalization::kWhereDull) << "\n"
             << "show_track: " << options.draw_tracks << "\n"
             << "fisheye_mask: " << (options.mask_file.empty() ? "none" : options.mask_file) << "\n"
             << "gyroscope predicts: " << options.uses_gyroscope << "\n"
             << "feature_border: " << options.border << " px\n"
             << "corner_quality: " << options.corner_quality << " grey values/px\n"
             << "klt_window: " << options.window << " px\n"
             << "klt_levels: " << options.pyramid_levels << "\n"
             << "klt_backward: " << options.backward_tolerance << " px\n"
             << "max_image_gap: " << options.max_gap << " s\n"
             << "min_tracks: " << options.min_tracks << "\n"
             << "tracker_seed: " << options.seed << "\n";
}

FeatureTrackerOptions readFeatureTrackerOptions(const Parameters& parameters,
                                                const camera_model::Rig& rig) {
  FeatureTrackerOptions options;
  const auto number = [&](const char* key, double* value, const Range& allowed) {
    *value = parameters.numberOr(key, *value, allowed);
  };
  const auto integer = [&](const char* key, int* value, const Range& allowed) {
    *value = parameters.integerOr(key, *value, allowed);
  };
  integer("max_cnt", &options.max_features, kMaxFeatures);
  number("min_dist", &options.min_distance, kMinDistance);
  number("freq", &options.frequency, kFrequency);
  number("F_threshold", &options.rejection_threshold, kThreshold);
  const bool equalize = parameters.flagOr("equalize", false);
  options.equalization = equalize ? Equalization::kWhereDull : Equalization::kNever;
  options.draw_tracks = parameters.flagOr("show_track", options.draw_tracks);
  options.mask_file = rig.cameras.front().mask_file;
  options.uses_gyroscope = rig.rotationIsKnown();
  integer("feature_border", &options.border, kBorder);
  number("corner_quality", &options.corner_quality, kQuality);
  integer("klt_window", &options.window, kWindow);
  integer("klt_levels", &options.pyramid_levels, kLevels);
  number("klt_backward", &options.backward_tolerance, kBackward);
  number("max_image_gap", &options.max_gap, kMaxGap);
  integer("min_tracks", &options.min_tracks, kMinTracks);
  options.seed = static_cast<std::uint64_t>(parameters.integerOr("tracker_seed", 1, kSeed));
  return options;
}

}  // namespace vins::feature_tracker
