#pragma once

#include <Eigen/Geometry>

#include "vins_estimator/visual/landmarks.h"

namespace vins::estimator {

/// How far two frames are apart for the camera.
struct FrameParallax {
  int shared = 0;       ///< tracks seen in both
  double parallax = 0;  ///< mean shift of the shared tracks, the rotation taken out [px]
};

/// `R_ba`: rotates bearings of frame a's camera to frame b's (from the gyroscope, which is why a
/// turning camera makes no keyframes; VINS-Mono, section IV-A).
FrameParallax parallaxBetween(const Landmarks& landmarks, FrameId a, FrameId b,
                              const Eigen::Quaterniond& R_ba);

/// When a frame is kept.
struct KeyframeChoiceOptions {
  double min_parallax = 10.0;     ///< against the last keyframe [px]
  double min_shared_ratio = 0.5;  ///< of the frame's tracks, seen in the last keyframe, too
  int min_shared = 20;            ///< tracks
  int min_tracks = 10;            ///< a frame with fewer is kept for the time's sake only
  double max_interval = 2.0;      ///< since the last keyframe [s]
};

/// For a camera that has rested since the last keyframe. New keyframes would tell nothing new, but
/// each that is marginalized for them lets what is not observable at rest - tilt against the
/// accelerometer's bias - slide a little.
KeyframeChoiceOptions restingChoice(KeyframeChoiceOptions moving);

/// The frame is worth keeping: `tracks` features, `seconds` after the last keyframe.
bool isKeyframe(const KeyframeChoiceOptions& options, const FrameParallax& against_last, int tracks,
                double seconds);

/// Tells whether the stamp of an image is in doubt, `before` seconds after its predecessor and
/// `after` seconds before its successor: two images that arrived together were stamped together
/// then, and the first shows what was before. Such a frame contradicts the IMU and may not stay.
bool isStampDoubtful(double before, double after);

}  // namespace vins::estimator
