#include "camera_model/undistortion.h"

#include <Eigen/LU>

namespace vins::camera_model {

UndistortionMap makeUndistortionMap(const Camera& camera, const Eigen::Matrix3d& K, ImageSize size,
                                    const Eigen::Matrix3d& R_cv) {
  UndistortionMap map{cv::Mat(size.height, size.width, CV_32FC1, cv::Scalar(-1.0)),
                      cv::Mat(size.height, size.width, CV_32FC1, cv::Scalar(-1.0))};
  const Eigen::Matrix3d ray_of_pixel = R_cv * K.inverse();
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const auto pixel = camera.project(ray_of_pixel * Eigen::Vector3d(u, v, 1.0));
      if (!pixel) continue;
      map.map_x.at<float>(v, u) = static_cast<float>(pixel->x());
      map.map_y.at<float>(v, u) = static_cast<float>(pixel->y());
    }
  }
  return map;
}

}  // namespace vins::camera_model
