#include "feature_tracker/mask_file.h"

#include <opencv2/imgcodecs.hpp>

#include "vins_core/input_error.h"

namespace vins::feature_tracker {

cv::Mat readMaskFile(const std::string& path, camera_model::ImageSize size) {
  if (path.empty()) return {};
  const cv::Mat image = cv::imread(path, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw InputError("fisheye_mask: cannot read an image from '" + path + "'");
  if (image.cols != size.width || image.rows != size.height) {
    throw InputError("fisheye_mask: '" + path + "' is " + std::to_string(image.cols) + "x" +
                     std::to_string(image.rows) + "; needed, as the camera's images: " +
                     std::to_string(size.width) + "x" + std::to_string(size.height));
  }
  return image >= 128;
}

}  // namespace vins::feature_tracker
