#include "vins_estimator/estimator_options.h"

#include <cmath>
#include <sstream>
#include <string>

#include <Eigen/Core>
#include <Eigen/LU>

#include "vins_core/input_error.h"
#include "vins_core/option_check.h"

namespace vins::estimator {
namespace {

constexpr Range kDensity{1e-9, 100.0};
constexpr Range kGravity{9.0, 10.5};  ///< [m/s^2]
constexpr Range kTimeOffset{-1.0, 1.0};
constexpr Range kPixelNoise{0.05, 20.0};
constexpr Range kWindowSize{4, 30};
constexpr Range kParallax{0.5, 200.0};
constexpr Range kMinTracks{5, 100};
constexpr Range kIterations{1, 100};
constexpr Range kSolverTime{0.0, 10.0};
constexpr Range kReadout{0.0, 0.2};
constexpr Range kHeight{16, 20000};
constexpr Range kSigma{1e-6, 3.0};
constexpr double kSampleAbove = 0.03;  ///< no density of a usable accelerometer is [m/s^2/sqrt(Hz)]
constexpr double kNotOrthogonal = 1e-2;  ///< of R^T R - 1: typed numbers with few digits pass

bool isRotation(const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d difference = R.transpose() * R - Eigen::Matrix3d::Identity();
  return difference.cwiseAbs().maxCoeff() < kNotOrthogonal && R.determinant() > 0.0;
}

Pose poseOf(const Eigen::Matrix3d& R, const Eigen::Vector3d& p) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() = R;
  T.topRightCorner<3, 1>() = p;
  return poseFromMatrix(T);
}

void requireRotation(const Parameters& parameters, const char* key, const Eigen::Matrix3d& R) {
  if (isRotation(R)) return;
  std::ostringstream found;
  found << "a matrix that is no rotation (determinant " << R.determinant() << ")";
  parameters.fail(key, found.str(), "a rotation: orthonormal rows, determinant 1");
}

/// Kalibr's: the IMU's coordinates taken to the camera.
Pose readKalibrExtrinsic(const Parameters& camera) {
  const Eigen::Matrix4d T_cb = camera.matrix("T_cam_imu", 4, 4);
  requireRotation(camera, "T_cam_imu", T_cb.topLeftCorner<3, 3>());
  return poseFromMatrix(T_cb).inverse();
}

bool hasKalibrExtrinsic(const Parameters& parameters) {
  return parameters.has("cam0") && parameters.section("cam0").has("T_cam_imu");
}

ExtrinsicMode readExtrinsicMode(const Parameters& parameters) {
  switch (parameters.integerOr("estimate_extrinsic", 0, {0, 2})) {
    case 0:
      return ExtrinsicMode::kTrusted;
    case 1:
      return ExtrinsicMode::kRefined;
    default:
      return ExtrinsicMode::kUnknown;
  }
}

Pose readExtrinsic(const Parameters& parameters, ExtrinsicMode mode) {
  const char* kRotation = "extrinsicRotation";
  const char* kTranslation = "extrinsicTranslation";
  const bool is_given = parameters.has(kRotation) || parameters.has(kTranslation);
  if (!is_given && hasKalibrExtrinsic(parameters)) {
    return readKalibrExtrinsic(parameters.section("cam0"));
  }
  if (!is_given && mode == ExtrinsicMode::kUnknown) return {};
  if (!parameters.has(kRotation)) {
    parameters.fail(kRotation, "nothing",
                    "a matrix of 3 x 3 numbers, camera to body; absent only where "
                    "estimate_extrinsic is 2");
  }
  const Eigen::Matrix3d R_bc = parameters.matrix(kRotation, 3, 3);
  requireRotation(parameters, kRotation, R_bc);
  return poseOf(R_bc, parameters.matrix(kTranslation, 3, 1));
}

double readTimeOffset(const Parameters& parameters) {
  if (!parameters.has("td") && hasKalibrExtrinsic(parameters)) {
    return parameters.section("cam0").numberOr("timeshift_cam_imu", 0.0, kTimeOffset);
  }
  return parameters.numberOr("td", 0.0, kTimeOffset);
}

MotionOnly readMotionOnly(const Parameters& parameters) {
  switch (parameters.integerOr("motion_only_ba", 2, {0, 2})) {
    case 0:
      return MotionOnly::kNever;
    case 1:
      return MotionOnly::kAlways;
    default:
      return MotionOnly::kWhenBehind;
  }
}

double readReadout(const Parameters& parameters) {
  const bool is_rolling = parameters.flagOr("rolling_shutter", false);
  const double readout = parameters.numberOr("rolling_shutter_tr", 0.0, kReadout);
  return is_rolling ? readout : 0.0;
}

ImuNoise readKalibrNoise(const Parameters& parameters, double gravity) {
  ImuNoise noise;
  noise.accelerometer_noise = parameters.number("accelerometer_noise_density", kDensity);
  noise.accelerometer_walk = parameters.number("accelerometer_random_walk", kDensity);
  noise.gyroscope_noise = parameters.number("gyroscope_noise_density", kDensity);
  noise.gyroscope_walk = parameters.number("gyroscope_random_walk", kDensity);
  noise.gravity = gravity;
  return noise;
}

const char* toString(ExtrinsicMode mode) {
  switch (mode) {
    case ExtrinsicMode::kTrusted:
      return "0 (trusted)";
    case ExtrinsicMode::kRefined:
      return "1 (refined)";
    case ExtrinsicMode::kUnknown:
      return "2 (unknown)";
  }
  return "unknown";
}

/// Everything but the vibration's share.
ImuNoise readDensities(const Parameters& parameters) {
  const double gravity = parameters.numberOr("g_norm", 9.81, kGravity);
  const std::string unit =
      parameters.textOr("imu_noise_unit", "auto", {"auto", "density", "sample"});
  const double rate = parameters.numberOr("imu_rate", 200.0, {10.0, 10000.0});
  if (!parameters.has("acc_n")) {
    if (parameters.has("accelerometer_noise_density")) return readKalibrNoise(parameters, gravity);
    if (parameters.has("imu0")) return readKalibrNoise(parameters.section("imu0"), gravity);
  }
  ImuNoise noise;
  noise.accelerometer_noise = parameters.number("acc_n", kDensity);
  noise.gyroscope_noise = parameters.number("gyr_n", kDensity);
  noise.accelerometer_walk = parameters.number("acc_w", kDensity);
  noise.gyroscope_walk = parameters.number("gyr_w", kDensity);
  noise.gravity = gravity;
  const bool is_sample =
      unit == "sample" || (unit == "auto" && noise.accelerometer_noise > kSampleAbove);
  if (!is_sample) return noise;
  for (double* value : {&noise.accelerometer_noise, &noise.gyroscope_noise,
                        &noise.accelerometer_walk, &noise.gyroscope_walk}) {
    *value /= std::sqrt(rate);
  }
  return noise;
}

}  // namespace

void EstimatorOptions::validate() const {
  imu.validate();
  if (!T_bc.position.allFinite() || !(std::abs(T_bc.rotation.norm() - 1.0) < 1e-6)) {
    throw InputError("estimator: T_bc is no pose; allowed: finite numbers, a unit quaternion");
  }
  requireWithin("estimator", "td", td, kTimeOffset);
  requireWithin("estimator", "pixel_noise", pixel_noise, kPixelNoise);
  requireWithin("estimator", "window_size", window_size, kWindowSize);
  requireWithin("estimator", "keyframe_parallax", keyframe_parallax, kParallax);
  requireWithin("estimator", "min_tracks", min_tracks, kMinTracks);
  requireWithin("estimator", "max_num_iterations", max_num_iterations, kIterations);
  requireWithin("estimator", "max_solver_time", max_solver_time, kSolverTime);
  requireWithin("estimator", "rolling_shutter_tr", rolling_shutter_readout, kReadout);
  if (rolling_shutter_readout > 0.0)
    requireWithin("estimator", "image_height", image_height, kHeight);
  requireWithin("estimator", "extrinsic_rotation_sigma", extrinsic_rotation_sigma, kSigma);
  requireWithin("estimator", "extrinsic_translation_sigma", extrinsic_translation_sigma, kSigma);
  requireWithin("estimator", "td_sigma", td_sigma, kSigma);
}

std::ostream& operator<<(std::ostream& out, const EstimatorOptions& options) {
  const Eigen::IOFormat row(Eigen::StreamPrecision, Eigen::DontAlignCols, ", ", "; ", "", "", "[",
                            "]");
  return out << options.imu << "estimate_extrinsic: " << toString(options.extrinsic) << "\n"
             << "extrinsicRotation: " << options.T_bc.rotation.toRotationMatrix().format(row)
             << "\nextrinsicTranslation: " << options.T_bc.position.transpose().format(row)
             << " m\n"
             << "td: " << options.td << " s, estimate_td: " << options.estimate_td << "\n"
             << "rolling_shutter_tr: " << options.rolling_shutter_readout << " s\n"
             << "extrinsic_rotation_sigma: " << options.extrinsic_rotation_sigma << " rad, "
             << "extrinsic_translation_sigma: " << options.extrinsic_translation_sigma << " m, "
             << "td_sigma: " << options.td_sigma << " s\n"
             << "motion_only_ba: " << static_cast<int>(options.motion_only) << "\n"
             << "pixel_noise: " << options.pixel_noise << " px\n"
             << "window_size: " << options.window_size << " keyframes\n"
             << "keyframe_parallax: " << options.keyframe_parallax << " px\n"
             << "min_tracks: " << options.min_tracks << "\n"
             << "max_num_iterations: " << options.max_num_iterations << "\n"
             << "max_solver_time: " << options.max_solver_time << " s\n"
             << "first_estimates: " << options.first_estimates << "\n";
}

EstimatorOptions readEstimatorOptions(const Parameters& parameters) {
  EstimatorOptions options;
  options.imu = readImuNoise(parameters);
  options.extrinsic = readExtrinsicMode(parameters);
  options.T_bc = readExtrinsic(parameters, options.extrinsic);
  options.td = readTimeOffset(parameters);
  options.estimate_td = parameters.flagOr("estimate_td", options.estimate_td);
  options.rolling_shutter_readout = readReadout(parameters);
  if (options.rolling_shutter_readout > 0.0) {
    options.image_height = parameters.integer("image_height", kHeight);
  }
  options.motion_only = readMotionOnly(parameters);
  options.extrinsic_rotation_sigma =
      parameters.numberOr("extrinsic_rotation_sigma", options.extrinsic_rotation_sigma, kSigma);
  options.extrinsic_translation_sigma = parameters.numberOr(
      "extrinsic_translation_sigma", options.extrinsic_translation_sigma, kSigma);
  options.td_sigma = parameters.numberOr("td_sigma", options.td_sigma, kSigma);
  options.pixel_noise = parameters.numberOr("pixel_noise", options.pixel_noise, kPixelNoise);
  options.window_size = parameters.integerOr("window_size", options.window_size, kWindowSize);
  options.keyframe_parallax =
      parameters.numberOr("keyframe_parallax", options.keyframe_parallax, kParallax);
  options.min_tracks = parameters.integerOr("min_tracks", options.min_tracks, kMinTracks);
  options.max_num_iterations =
      parameters.integerOr("max_num_iterations", options.max_num_iterations, kIterations);
  options.max_solver_time =
      parameters.numberOr("max_solver_time", options.max_solver_time, kSolverTime);
  options.validate();
  return options;
}

ImuNoise readImuNoise(const Parameters& parameters) {
  ImuNoise noise = readDensities(parameters);
  noise.vibration_share = parameters.numberOr("vibration_share", noise.vibration_share, {0.0, 1.0});
  return noise;
}

}  // namespace vins::estimator
