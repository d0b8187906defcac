#include "track_table.h"

#include <algorithm>

#include "feature_tracker/flow_prediction.h"

namespace vins::feature_tracker {
namespace {

constexpr double kSameLook = 0.8;           // correlation with the patch as it was at first
constexpr float kLongestCorrection = 3.0F;  // [px]: further, something else was found
constexpr double kSmallest = 0.6;           // sizes beyond which a patch is remembered anew
constexpr double kLargest = 1.7;

}  // namespace

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

void TrackTable::pixels(std::vector<cv::Point2f>* pixels) const {
  pixels->clear();
  for (const FeatureTrack& track : tracks_) pixels->push_back(track.sight.pixel);
}

void TrackTable::predict(const Quaterniond& R_21, double interval,
                         std::vector<cv::Point2f>* predicted) const {
  predicted->clear();
  for (const FeatureTrack& track : tracks_) {
    const auto turned = turnedPixel(*camera_, track.sight.bearing, R_21);
    predicted->push_back(turned ? toPoint(*turned + interval * track.drift) : track.sight.pixel);
  }
}

bool TrackTable::move(FeatureTrack* track, const cv::Point2f& pixel, const Quaterniond& R_21,
                      double interval) const {
  const auto bearing = camera_->unproject(toEigen(pixel));
  if (!bearing) return false;
  const auto resolution = angularResolution(*camera_, *bearing);
  if (!resolution) return false;
  const auto turned = turnedPixel(*camera_, track->sight.bearing, R_21);
  track->drift = turned ? Vector2d((toEigen(pixel) - *turned) / interval) : Vector2d::Zero();
  TrackSight& sight = track->sight;
  sight.bearing_velocity = (*bearing - sight.bearing) / interval;
  sight.bearing = *bearing;
  sight.pixel = pixel;
  sight.angular_resolution = *resolution;
  ++sight.images;
  return true;
}

void TrackTable::align(const cv::Mat& image, std::vector<cv::Point2f>* pixels,
                       std::vector<std::uint8_t>* found) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if ((*found)[i] == 0) continue;
    AnchoredPatch& patch = tracks_[i].patch;
    cv::Point2f& pixel = (*pixels)[i];
    const PatchAlignment alignment = patch.align(image, pixel);
    if (!alignment.inside) continue;
    const cv::Point2f correction = alignment.pixel - pixel;
    const bool is_same = alignment.correlation >= kSameLook &&
                         correction.dot(correction) <= kLongestCorrection * kLongestCorrection;
    if (!is_same) {
      (*found)[i] = 0;
      continue;
    }
    pixel = alignment.pixel;
    if (patch.scale() < kSmallest || patch.scale() > kLargest) patch.anchor(image, pixel);
  }
}

void TrackTable::advance(const std::vector<cv::Point2f>& pixels,
                         const std::vector<std::uint8_t>& found, const CornerGrid& grid,
                         const Quaterniond& R_21, double interval,
                         std::vector<BearingPair>* pairs) {
  pairs->clear();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (found[i] == 0 || !grid.allows(pixels[i])) continue;
    FeatureTrack track = tracks_[i];
    const Vector3d before = track.sight.bearing;
    if (!move(&track, pixels[i], R_21, interval)) continue;
    pairs->push_back({before, track.sight.bearing, track.sight.angular_resolution});
    tracks_[kept++] = track;
  }
  tracks_.resize(kept);
}

void TrackTable::remember(std::uint32_t image) {
  for (FeatureTrack& track : tracks_) {
    track.past[image % FeatureTrack::kMemory] = track.sight.bearing;
  }
}

void TrackTable::pairsSince(std::uint32_t image, std::uint32_t ago, std::vector<BearingPair>* pairs,
                            std::vector<std::size_t>* indices) const {
  pairs->clear();
  indices->clear();
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const FeatureTrack& track = tracks_[i];
    if (track.sight.images <= static_cast<int>(ago)) continue;
    pairs->push_back({track.past[(image - ago) % FeatureTrack::kMemory], track.sight.bearing,
                      track.sight.angular_resolution});
    indices->push_back(i);
  }
}

void TrackTable::keep(const std::vector<std::uint8_t>& marks) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (marks[i] != 0) tracks_[kept++] = tracks_[i];
  }
  tracks_.resize(kept);
}

void TrackTable::thinOut(double distance) {
  const double limit = distance * distance;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const cv::Point2f pixel = tracks_[i].sight.pixel;
    const bool is_free =
        std::none_of(tracks_.begin(), tracks_.begin() + static_cast<std::ptrdiff_t>(kept),
                     [&](const FeatureTrack& older) {
                       const cv::Point2f d = older.sight.pixel - pixel;
                       return d.dot(d) < limit;
                     });
    if (is_free) tracks_[kept++] = tracks_[i];
  }
  tracks_.resize(kept);
}

int TrackTable::add(const cv::Mat& image, const std::vector<Corner>& corners) {
  int added = 0;
  for (const Corner& corner : corners) {
    const auto bearing = camera_->unproject(toEigen(corner.pixel));
    if (!bearing) continue;
    const auto resolution = angularResolution(*camera_, *bearing);
    if (!resolution) continue;
    FeatureTrack track;
    track.id = next_id_++;
    track.sight = TrackSight{corner.pixel, *bearing, Vector3d::Zero(), *resolution, 1};
    track.patch.anchor(image, corner.pixel);
    tracks_.push_back(track);
    ++added;
  }
  return added;
}

double TrackTable::meanLength() const {
  double sum = 0.0;
  for (const FeatureTrack& track : tracks_) sum += track.sight.images;
  return tracks_.empty() ? 0.0 : sum / static_cast<double>(tracks_.size());
}

void TrackTable::observe(std::vector<FeatureObservation>* observations) const {
  const auto add = [observations](std::int64_t id, int camera, const TrackSight& sight) {
    observations->push_back({id, camera, sight.images, toEigen(sight.pixel), sight.bearing,
                             sight.bearing_velocity, sight.angular_resolution});
  };
  observations->reserve(2 * tracks_.size());
  for (const FeatureTrack& track : tracks_) add(track.id, 0, track.sight);
  for (const FeatureTrack& track : tracks_) {
    if (track.second) add(track.id, 1, *track.second);
  }
}

}  // namespace vins::feature_tracker
