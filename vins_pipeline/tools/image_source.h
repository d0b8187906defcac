#pragma once

#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace vins::pipeline {

/// Which images are taken of recordings.
struct ImageSourceOptions {
  std::string imu_topic = "/imu0";
  std::string image_topic = "/cam0/image_raw";
  double every = 0.5;  ///< at most one image in this time [s]
};

/// An image that is read when asked for, as grey values (CV_8UC1). Throws InputError naming the
/// file where it cannot be read.
using ImageLoader = std::function<cv::Mat()>;

/// The images of a file, of a folder of files (in the order of their names), of a folder in the
/// ASL layout, or of a ROS bag. Throws InputError where there are none.
std::vector<ImageLoader> findImages(const std::string& path, const ImageSourceOptions& options);

}  // namespace vins::pipeline
