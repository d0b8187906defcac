#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "camera_model/camera.h"
#include "vins_core/pose.h"

namespace vins::feature_tracker::testing {

/// A plane with a texture of blobs of all sizes, z = `depth` in the world's frame, that repeats for
/// ever. Says what a camera at any pose in front of it sees.
class PlaneWorld {
 public:
  explicit PlaneWorld(std::shared_ptr<const camera_model::Camera> camera, double depth = 4.0)
      : camera_(std::move(camera)), depth_(depth), texture_(paint()) {}

  const camera_model::Camera& camera() const { return *camera_; }

  /// Image (CV_8UC1) of a camera at T_wc. Black where it does not see the plane.
  cv::Mat render(const Pose& T_wc) const {
    const camera_model::ImageSize size = camera_->imageSize();
    cv::Mat1f x(size.height, size.width), y(size.height, size.width);
    for (int v = 0; v < size.height; ++v) {
      for (int u = 0; u < size.width; ++u) {
        const auto p_w = pointAt(T_wc, Eigen::Vector2d(u, v));
        // A column's distance from the texture's edge is no matter: it repeats.
        x(v, u) = p_w ? wrapped(p_w->x() * kPixelsPerMetre) : -10.0F;
        y(v, u) = p_w ? wrapped(p_w->y() * kPixelsPerMetre) : -10.0F;
      }
    }
    cv::Mat image;
    cv::remap(texture_, image, x, y, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
    return image;
  }

  /// The point that a pixel sees [m].
  std::optional<Eigen::Vector3d> pointAt(const Pose& T_wc, const Eigen::Vector2d& pixel) const {
    const auto bearing = camera_->unproject(pixel);
    if (!bearing) return std::nullopt;
    const Eigen::Vector3d direction = T_wc.rotation * *bearing;
    const double distance = (depth_ - T_wc.position.z()) / direction.z();
    if (!(direction.z() > 0.05) || distance <= 0.0) return std::nullopt;
    return T_wc.position + distance * direction;
  }

  std::optional<Eigen::Vector2d> project(const Pose& T_wc, const Eigen::Vector3d& p_w) const {
    return camera_->project(T_wc.inverse() * p_w);
  }

 private:
  static constexpr int kSide = 1024;  // of the texture [px]
  static constexpr double kPixelsPerMetre = 120.0;

  static float wrapped(double coordinate) {
    return static_cast<float>(coordinate - kSide * std::floor(coordinate / kSide));
  }

  /// Blurred noise of several sizes; a margin repeats the other side for the interpolation.
  static cv::Mat paint() {
    cv::Mat1f sum = cv::Mat1f::zeros(kSide, kSide);
    cv::RNG random(7);
    for (const double sigma : {1.6, 4.0, 10.0}) {
      cv::Mat1f noise(kSide, kSide);
      random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
      cv::Mat wide;
      cv::copyMakeBorder(noise, wide, 64, 64, 64, 64, cv::BORDER_WRAP);
      cv::GaussianBlur(wide, wide, cv::Size(), sigma);
      sum += wide(cv::Rect(64, 64, kSide, kSide)) * (28.0 * 3.5 * sigma / 1.6);
    }
    cv::Mat texture;
    sum.convertTo(texture, CV_8U, 0.6, 120.0);
    cv::copyMakeBorder(texture, texture, 0, 1, 0, 1, cv::BORDER_WRAP);
    return texture;
  }

  std::shared_ptr<const camera_model::Camera> camera_;
  double depth_;
  cv::Mat texture_;
};

}  // namespace vins::feature_tracker::testing
