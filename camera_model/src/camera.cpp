#include "camera_model/camera.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "vins_core/input_error.h"

namespace vins::camera_model {

const char* toString(CameraModel model) {
  switch (model) {
    case CameraModel::kPinhole:
      return "PINHOLE";
    case CameraModel::kKannalaBrandt:
      return "KANNALA_BRANDT";
    case CameraModel::kMei:
      return "MEI";
    case CameraModel::kScaramuzza:
      return "SCARAMUZZA";
    case CameraModel::kDoubleSphere:
      return "DOUBLE_SPHERE";
    case CameraModel::kEucm:
      return "EUCM";
  }
  return "unknown";
}

CameraModel cameraModelFromString(const std::string& name) {
  std::string upper = name;
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::toupper(c));
  });
  for (const CameraModel model : kCameraModels) {
    if (upper == toString(model)) return model;
  }
  throw InputError("camera model: found '" + name +
                   "'; allowed: pinhole, kannala-brandt, mei, scaramuzza, "
                   "double-sphere, eucm");
}

Camera::Camera(std::string name, ImageSize size) : name_(std::move(name)), size_(size) {
  if (size.width <= 0 || size.height <= 0) {
    throw InputError("camera '" + name_ + "': found an image of " + std::to_string(size.width) +
                     " x " + std::to_string(size.height) + "; allowed: at least 1 x 1");
  }
}

void Camera::requirePositive(const char* parameter, double value) const {
  if (value > 0.0) return;
  throw InputError("camera '" + name_ + "': " + parameter + ": found " + std::to_string(value) +
                   "; allowed: a number above 0");
}

void Camera::requireFinite(const CameraParameters& parameters) const {
  if (parameters.allFinite()) return;
  throw InputError("camera '" + name_ + "': found a parameter that is not finite");
}

void Camera::requireCount(CameraModel model, const CameraParameters& parameters, int count) {
  if (parameters.size() == count) return;
  throw InputError(std::string("camera model ") + toString(model) + ": found " +
                   std::to_string(parameters.size()) +
                   " parameters; allowed: " + std::to_string(count));
}

}  // namespace vins::camera_model
