#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "camera_model/camera.h"

namespace vins::feature_tracker {

/// Places where a track has just failed: on a moving object, at the edge of something near, in a
/// reflection. A new corner there would fail as well, so they are left alone for some images.
class ShunnedPlaces {
 public:
  explicit ShunnedPlaces(std::shared_ptr<const camera_model::Camera> camera)
      : camera_(std::move(camera)) {}

  /// Adds a place for the next `images` images.
  void add(const Eigen::Vector3d& bearing, int images) { places_.push_back({bearing, images}); }

  /// Turns the places with the camera, and forgets those whose time is over.
  void nextImage(const Eigen::Quaterniond& R_21);

  /// Their pixels, of those in view.
  std::vector<cv::Point2f> pixels() const;

  void clear() { places_.clear(); }

 private:
  struct Place {
    Eigen::Vector3d bearing;
    int images_left = 0;
  };

  std::shared_ptr<const camera_model::Camera> camera_;
  std::vector<Place> places_;
};

}  // namespace vins::feature_tracker
