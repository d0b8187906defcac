#include "camera_model/opencv_intrinsics.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "camera_model/kannala_brandt.h"
#include "camera_model/pinhole_radtan.h"
#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

constexpr double kTolerance = 0.01;  ///< of focal length and centre, relative

/// The coefficients without the zeros behind the first `count`, to which zeros are added.
std::vector<double> withCount(std::vector<double> k, std::size_t count, const std::string& model) {
  const auto is_zero = [](double value) { return value == 0.0; };
  const std::size_t kept = std::min(count, k.size());
  if (!std::all_of(k.begin() + static_cast<std::ptrdiff_t>(kept), k.end(), is_zero)) {
    throw InputError("D has " + std::to_string(k.size()) + " coefficients of the model '" + model +
                     "'; allowed: at most " + std::to_string(count) + " that are not zero");
  }
  k.resize(count, 0.0);
  return k;
}

void requireIntrinsics(const OpencvIntrinsics& intrinsics) {
  if (intrinsics.fx > 0.0 && intrinsics.fy > 0.0) return;
  std::ostringstream text;
  text << "K has the focal lengths " << intrinsics.fx << " and " << intrinsics.fy
       << "; allowed: above 0 (zeros say that the camera is not calibrated)";
  throw InputError(text.str());
}

CameraParameters toParameters(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<int>(values.size()));
}

/// Focal lengths and centre on the optical axis [px].
struct AxisFigures {
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
};

AxisFigures figuresOf(const Camera& camera) {
  ProjectionJacobians J;
  const auto centre = camera.project(Eigen::Vector3d::UnitZ(), &J);
  if (!centre) return {};
  return {J.J_pixel_point(0, 0), J.J_pixel_point(1, 1), centre->x(), centre->y()};
}

std::string textOf(const Camera& camera, const AxisFigures& figures) {
  std::ostringstream text;
  text << camera.imageSize().width << " x " << camera.imageSize().height << ", fx " << figures.fx
       << ", fy " << figures.fy << ", cx " << figures.cx << ", cy " << figures.cy;
  return text.str();
}

bool agree(double a, double b, double unit) { return std::abs(a - b) <= kTolerance * unit; }

}  // namespace

std::unique_ptr<Camera> makeCamera(const OpencvIntrinsics& intrinsics, const std::string& name) {
  const std::string& model = intrinsics.distortion_model;
  const bool is_fisheye = model == "equidistant" || model == "fisheye";
  if (!is_fisheye && model != "plumb_bob" && model != "rational_polynomial") {
    throw InputError("distortion_model is '" + model +
                     "'; allowed: plumb_bob, rational_polynomial, equidistant, fisheye");
  }
  requireIntrinsics(intrinsics);
  const std::vector<double> K = {intrinsics.fx, intrinsics.fy, intrinsics.cx, intrinsics.cy};
  std::vector<double> values = withCount(intrinsics.coefficients, is_fisheye ? 4 : 8, model);
  if (is_fisheye) {
    values.insert(values.end(), K.begin(), K.end());
    return std::make_unique<KannalaBrandt>(name, intrinsics.size, toParameters(values));
  }
  const bool is_polynomial = values[5] == 0.0 && values[6] == 0.0 && values[7] == 0.0;
  values.resize(is_polynomial ? 5 : 8);
  values.insert(values.begin(), K.begin(), K.end());
  return std::make_unique<PinholeRadtan>(name, intrinsics.size, toParameters(values));
}

std::optional<std::string> describeDifference(const Camera& of_file, const Camera& of_topic,
                                              const std::string& topic) {
  const AxisFigures a = figuresOf(of_file), b = figuresOf(of_topic);
  const double width = of_file.imageSize().width;
  if (of_file.imageSize() == of_topic.imageSize() && agree(a.fx, b.fx, a.fx) &&
      agree(a.fy, b.fy, a.fy) && agree(a.cx, b.cx, width) && agree(a.cy, b.cy, width)) {
    return std::nullopt;
  }
  return "the file's camera (" + textOf(of_file, a) + ") differs from that of " + topic + " (" +
         textOf(of_topic, b) + "): the file's counts; leave it out to take the topic's";
}

}  // namespace vins::camera_model
