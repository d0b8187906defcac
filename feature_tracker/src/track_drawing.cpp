#include "feature_tracker/track_drawing.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace vins::feature_tracker {
namespace {

constexpr int kShift = 3;               // drawing functions take eighths of a pixel
constexpr double kLongestTail = 100.0;  // [px]

cv::Point fine(const Eigen::Vector2d& pixel) {
  const double unit = 1 << kShift;
  return {static_cast<int>(std::lround(pixel.x() * unit)),
          static_cast<int>(std::lround(pixel.y() * unit))};
}

/// Red, orange, yellow, green, blue (in BGR) from 0 to 1.
cv::Scalar colourOf(double age) {
  const double hue = 2.0 / 3.0 * std::clamp(age, 0.0, 1.0);  // of a full turn
  const auto channel = [hue](double centre) {
    double distance = std::abs(hue - centre);
    distance = std::min(distance, 1.0 - distance);
    return 255.0 * std::clamp(2.0 - 6.0 * distance, 0.0, 1.0);
  };
  return {channel(2.0 / 3.0), channel(1.0 / 3.0), channel(0.0)};
}

void drawTail(const FeatureObservation& observation, const camera_model::Camera& camera,
              double seconds, const cv::Scalar& colour, cv::Mat* picture) {
  if (!observation.hasVelocity()) return;
  const auto from = camera.project(observation.bearing - seconds * observation.bearing_velocity);
  if (!from || (*from - observation.pixel).norm() > kLongestTail) return;
  cv::line(*picture, fine(*from), fine(observation.pixel), colour, 1, cv::LINE_AA, kShift);
}

}  // namespace

cv::Mat drawTracks(const cv::Mat& image, const FeatureFrame& frame,
                   const camera_model::Camera& camera, int camera_index,
                   const TrackDrawingOptions& options) {
  cv::Mat picture;
  if (image.channels() == 1) {
    cv::cvtColor(image, picture, cv::COLOR_GRAY2BGR);
  } else {
    picture = image.clone();
  }
  const int radius = std::max(2, image.cols / 220);
  for (const FeatureObservation& observation : frame.observations) {
    if (observation.camera != camera_index) continue;
    const cv::Scalar colour =
        colourOf((observation.track_length - 1.0) / std::max(1, options.full_age - 1));
    drawTail(observation, camera, options.trail_seconds, colour, &picture);
    cv::circle(picture, fine(observation.pixel), radius << kShift, colour, 1, cv::LINE_AA, kShift);
  }
  return picture;
}

}  // namespace vins::feature_tracker
