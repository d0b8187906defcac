#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera_model/camera.h"

namespace vins::camera_model {

/// Intrinsics in the form in which OpenCV's calibrations and ROS's camera_info give them.
struct OpencvIntrinsics {
  /// ROS's name: plumb_bob, rational_polynomial, equidistant or fisheye.
  std::string distortion_model;
  ImageSize size;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< of the matrix K [px]
  std::vector<double> coefficients;               ///< D: k1, k2, p1, p2, k3, ...; or k1 to k4
};

/// Camera of these intrinsics: PINHOLE, with rational distortion where there are eight
/// coefficients, or KANNALA_BRANDT. Zeros behind a model's coefficients are ignored, and so is the
/// difference between plumb_bob and rational_polynomial. Throws InputError naming what was found
/// and what is allowed: another model, a K of zeros, another number of coefficients.
std::unique_ptr<Camera> makeCamera(const OpencvIntrinsics& intrinsics, const std::string& name);

/// Says in a line where two cameras differ, with both figures: in the image size, or by more than
/// 1 % in the focal length or, of the image's width, in the centre. Both are taken on the optical
/// axis, so that cameras of different models can be compared. Nothing where they agree.
std::optional<std::string> describeDifference(const Camera& of_file, const Camera& of_topic,
                                              const std::string& topic);

}  // namespace vins::camera_model
