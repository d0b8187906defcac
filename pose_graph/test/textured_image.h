#pragma once

#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace vins::pose_graph::testing {

/// Rectangles upon rectangles, of 5 to 30 pixels, in random grey values: corners all over, no place
/// like another.
inline cv::Mat1b texturedImage(int width, int height, int seed) {
  cv::RNG random(static_cast<std::uint64_t>(seed) + 1);
  cv::Mat1b image(height, width, 128);
  for (int i = 0; i < width * height / 50; ++i) {
    const cv::Point corner(random.uniform(-10, width), random.uniform(-10, height));
    const cv::Size size(random.uniform(5, 30), random.uniform(5, 30));
    cv::rectangle(image, cv::Rect(corner, size), random.uniform(0, 256), cv::FILLED);
  }
  return image;
}

}  // namespace vins::pose_graph::testing
