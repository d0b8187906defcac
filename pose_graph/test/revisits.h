#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "camera_model/testing/example_cameras.h"
#include "pose_graph/place/spread_corners.h"
#include "textured_image.h"
#include "vins_core/heading.h"
#include "vins_core/keyframe.h"
#include "vins_core/so3.h"

namespace vins::pose_graph::testing {

/// A body that comes to a row of places, each of which looks different: keyframes and images as the
/// estimator hands them on. The same place looks exactly the same whenever it is visited.
class Revisits {
 public:
  static constexpr Stamp kPeriod = 500'000'000;  ///< between keyframes [ns]

  const std::shared_ptr<const camera_model::Camera> camera =
      vins::camera_model::testing::exampleCameras().front();

  /// Where the body truly stands at a place: on a circle of 6 m, looking outwards.
  static Pose truth(int place) {
    const double angle = 0.3 * place;
    const Eigen::Vector3d lean(0.05 * std::sin(2.0 * angle), 0.04 * std::cos(angle), 0.0);
    return {yawRotation(angle) * so3::exp(lean),
            {6.0 * std::cos(angle), 6.0 * std::sin(angle), 0.2 * angle}};
  }

  cv::Mat image(int place) const {
    const camera_model::ImageSize size = camera->imageSize();
    return texturedImage(size.width, size.height, place);
  }

  /// The keyframe at a place, whose odometry has drifted to T_wm (world <- truth).
  Keyframe keyframe(std::int64_t id, int place, const Pose& T_wm = {},
                    std::uint32_t sequence = 0) const {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.sequence = sequence;
    keyframe.stamp = (id + 1) * kPeriod;
    keyframe.T_wb = T_wm * truth(place);
    keyframe.T_bc = {so3::exp({-1.2, 1.2, -1.2}), {0.1, 0.0, 0.02}};
    SpreadCornersOptions few;
    few.max_corners = 120;
    few.border = 30;
    std::int64_t track = 1000 * id;
    for (const cv::Point2f& corner : findSpreadCorners(image(place), {}, few)) {
      KeyframePoint point;
      point.id = track++;
      point.pixel = {corner.x, corner.y};
      const auto bearing = camera->unproject(point.pixel);
      if (!bearing) continue;
      point.bearing = *bearing;
      const double depth = 3.0 + static_cast<double>(track % 7);  // [m]
      point.position_w = keyframe.T_wb * (keyframe.T_bc * (depth * point.bearing));
      keyframe.points.push_back(point);
    }
    return keyframe;
  }
};

}  // namespace vins::pose_graph::testing
