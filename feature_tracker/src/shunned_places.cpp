#include "shunned_places.h"

#include <algorithm>

#include "feature_tracker/feature_track.h"

namespace vins::feature_tracker {

void ShunnedPlaces::nextImage(const Eigen::Quaterniond& R_21) {
  for (Place& place : places_) {
    place.bearing = R_21 * place.bearing;
    --place.images_left;
  }
  const auto is_over = [](const Place& place) { return place.images_left <= 0; };
  places_.erase(std::remove_if(places_.begin(), places_.end(), is_over), places_.end());
}

std::vector<cv::Point2f> ShunnedPlaces::pixels() const {
  std::vector<cv::Point2f> pixels;
  for (const Place& place : places_) {
    const auto pixel = camera_->project(place.bearing);
    if (pixel && camera_->contains(*pixel)) pixels.push_back(toPoint(*pixel));
  }
  return pixels;
}

}  // namespace vins::feature_tracker
