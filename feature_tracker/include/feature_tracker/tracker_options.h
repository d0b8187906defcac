#pragma once

#include <cstdint>
#include <ostream>
#include <string>

#include "camera_model/rig.h"
#include "vins_core/parameters.h"

namespace vins::feature_tracker {

/// When CLAHE (contrast limited adaptive histogram equalization) is applied to the images.
enum class Equalization {
  kNever,     ///< equalize: 0
  kWhereDull  ///< equalize: 1, in images whose grey values fill only a small range
};

/// What the feature tracker can be told. The defaults suit a 752x480 camera at 20 Hz.
struct FeatureTrackerOptions {
  int max_features = 150;            ///< max_cnt: tracks per image
  double min_distance = 30.0;        ///< min_dist: between tracks at detection [px]
  double frequency = 0.0;            ///< freq: of the frames handed out [Hz]; 0 is every image
  double rejection_threshold = 1.0;  ///< F_threshold: distance to the epipolar plane [px]
  Equalization equalization = Equalization::kNever;  ///< equalize
  bool draw_tracks = true;  ///< show_track: a picture is drawn where somebody subscribes
  std::string mask_file;    ///< fisheye_mask where fisheye is 1; empty: no mask
  /// The gyroscope predicts how the image turns. Needs the camera's rotation in the body frame: not
  /// where estimate_extrinsic is 2, live and offline alike.
  bool uses_gyroscope = true;

  int border = 8;                   ///< feature_border: no track is nearer to the edge [px]
  double corner_quality = 2.5;      ///< corner_quality: smallest score, see CornerGrid [grey/px]
  int window = 16;                  ///< klt_window: side of the patch that is followed [px]
  int pyramid_levels = 4;           ///< klt_levels: images in a pyramid, the original included
  double backward_tolerance = 0.7;  ///< klt_backward: of a track's way back to its start [px]
  double max_gap = 1.0;             ///< max_image_gap: a longer pause restarts the tracker [s]
  int min_tracks = 10;              ///< min_tracks: fewer are reported as tracking_lost
  std::uint64_t seed = 1;           ///< tracker_seed: of the outlier rejection's random samples

  /// Throws InputError naming the key of the first value that is out of range.
  void validate() const;
};

/// A line per option: key, value and unit.
std::ostream& operator<<(std::ostream& out, const FeatureTrackerOptions& options);

/// Reads the keys named above, as VINS-Mono's configuration files have them. Each has a default.
/// `rig` decides on the mask and on the gyroscope. Throws InputError naming file, key, what was
/// found and what is allowed.
FeatureTrackerOptions readFeatureTrackerOptions(const Parameters& parameters,
                                                const camera_model::Rig& rig);

}  // namespace vins::feature_tracker
