#include "vins_estimator/visual/keyframe_choice.h"

#include <algorithm>

namespace vins::estimator {
FrameParallax parallaxBetween(const Landmarks& landmarks, FrameId a, FrameId b,
                              const Eigen::Quaterniond& R_ba) {
  FrameParallax result;
  for (const auto& [id, track] : landmarks.tracks()) {
    const TrackObservation* in_a = track.observationIn(a);
    const TrackObservation* in_b = track.observationIn(b);
    if (in_a == nullptr || in_b == nullptr) continue;
    const Eigen::Vector3d shift = R_ba * in_a->measured.bearing - in_b->measured.bearing;
    result.parallax += shift.norm() / in_b->angular_resolution;
    ++result.shared;
  }
  if (result.shared > 0) result.parallax /= result.shared;
  return result;
}

KeyframeChoiceOptions restingChoice(KeyframeChoiceOptions moving) {
  moving.min_shared_ratio = 0.0;
  moving.max_interval = 30.0;
  return moving;
}

bool isKeyframe(const KeyframeChoiceOptions& options, const FrameParallax& against_last, int tracks,
                double seconds) {
  const double min_shared = std::max<double>(options.min_shared, options.min_shared_ratio * tracks);
  if (seconds >= options.max_interval) return true;
  // A blind frame is worth nothing, and would push one out that has seen something.
  if (tracks < options.min_tracks) return false;
  return against_last.shared < min_shared || against_last.parallax >= options.min_parallax;
}

bool isStampDoubtful(double before, double after) {
  constexpr double kShare = 0.1;  // cameras that skip nine images of ten are not met
  return after < kShare * before;
}

}  // namespace vins::estimator
