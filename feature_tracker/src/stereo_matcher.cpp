#include "feature_tracker/stereo_matcher.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "feature_tracker/flow_prediction.h"
#include "feature_tracker/outlier_rejection.h"

namespace vins::feature_tracker {

using Eigen::Vector2d;
using Eigen::Vector3d;

StereoMatcher::StereoMatcher(std::shared_ptr<const camera_model::Camera> second, const Pose& T_10,
                             double threshold, const OpticalFlowOptions& options)
    : camera_(std::move(second)), T_10_(T_10), threshold_(threshold), flow_(options) {}

/// 1/m, by the point on the first bearing that is nearest to the second; 0 where not seen by both.
double StereoMatcher::inverseDepth(const FeatureTrack& track) const {
  if (!track.second) return 0.0;
  const Vector3d u = T_10_.rotation * track.sight.bearing;
  const Vector3d along_second = u.cross(track.second->bearing);
  const Vector3d baseline = T_10_.position.cross(track.second->bearing);
  const double length = baseline.squaredNorm();
  // depth * (u x v) + (t x v) = 0, in the least-squares sense for 1 / depth.
  return length > 0.0 ? std::max(0.0, -along_second.dot(baseline) / length) : 0.0;
}

double StereoMatcher::medianInverseDepth(const std::vector<FeatureTrack>& tracks) const {
  std::vector<double> depths;
  for (const FeatureTrack& track : tracks) {
    if (track.second) depths.push_back(inverseDepth(track));
  }
  if (depths.empty()) return 0.0;
  std::nth_element(depths.begin(), depths.begin() + depths.size() / 2, depths.end());
  return depths[depths.size() / 2];
}

cv::Point2f StereoMatcher::predict(const FeatureTrack& track, double typical_inverse_depth) const {
  const double inverse_depth = track.second ? inverseDepth(track) : typical_inverse_depth;
  const Vector3d bearing = T_10_.rotation * track.sight.bearing + inverse_depth * T_10_.position;
  const auto pixel = camera_->project(bearing);
  return pixel ? toPoint(*pixel) : track.sight.pixel;
}

bool StereoMatcher::look(const FeatureTrack& track, const cv::Point2f& pixel, double interval,
                         TrackSight* sight) const {
  if (!camera_->contains(toEigen(pixel))) return false;
  const auto bearing = camera_->unproject(toEigen(pixel));
  if (!bearing) return false;
  const auto resolution = angularResolution(*camera_, *bearing);
  if (!resolution) return false;
  const BearingPair pair{track.sight.bearing, *bearing, *resolution};
  const RelativeMotion rig{T_10_.rotation, T_10_.position.normalized()};
  if (epipolarDistance(pair, rig) > threshold_ || displacement(pair, rig) < -threshold_) {
    return false;
  }
  *sight = TrackSight{pixel, *bearing, Vector3d::Zero(), *resolution, 1};
  if (track.second && interval > 0.0) {
    sight->bearing_velocity = (*bearing - track.second->bearing) / interval;
    sight->images = track.second->images + 1;
  }
  return true;
}

int StereoMatcher::match(const ImagePyramid& first, const ImagePyramid& second, double interval,
                         std::vector<FeatureTrack>* tracks) {
  const double typical = medianInverseDepth(*tracks);
  points_.clear();
  matched_.clear();
  for (const FeatureTrack& track : *tracks) {
    points_.push_back(track.sight.pixel);
    matched_.push_back(predict(track, typical));
  }
  flow_.track(first, second, points_, &matched_, &found_);
  int count = 0;
  for (std::size_t i = 0; i < tracks->size(); ++i) {
    FeatureTrack& track = (*tracks)[i];
    TrackSight sight;
    const bool seen = found_[i] != 0 && look(track, matched_[i], interval, &sight);
    track.second = seen ? std::make_optional(sight) : std::nullopt;
    count += seen ? 1 : 0;
  }
  return count;
}

}  // namespace vins::feature_tracker
