#include "vins_estimator/health/track_watch.h"

namespace vins::estimator {

std::optional<Event> TrackWatch::addFrame(Stamp stamp, int tracks) {
  if ((tracks < min_tracks_) == isLost()) return std::nullopt;
  const double count = tracks;
  if (!isLost()) {
    lost_since_ = stamp;
    return Event{stamp,
                 Severity::kWarning,
                 "tracking_lost",
                 "too few features: going on by the IMU alone. Is the lens free, is there light?",
                 {{"tracks", count}, {"needed", static_cast<double>(min_tracks_)}}};
  }
  const double seconds = toSeconds(stamp - *lost_since_);
  lost_since_.reset();
  return Event{stamp,
               Severity::kInfo,
               "tracking_resumed",
               "the images carry the estimate again",
               {{"tracks", count}, {"lost_s", seconds}}};
}

}  // namespace vins::estimator
