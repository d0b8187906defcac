#include "vins_estimator/estimator_options.h"

#include <cmath>
#include <sstream>

#include <Eigen/Core>

#include "vins_core/input_error.h"
#include "vins_core/option_check.h"

namespace vins::estimator {
namespace {

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

void readSelfCalibration(const Parameters& parameters, EstimatorOptions* options) {
  const auto flag = [&](const char* key) { return parameters.flagOr(key, false); };
  const auto sigma = [&](const char* key, double* value) {
    *value = parameters.numberOr(key, *value, kSigma);
  };
  options->estimate_readout = flag("estimate_readout");
  options->estimate_intrinsics = flag("estimate_intrinsics");
  options->estimate_imu_intrinsics = flag("estimate_imu_intrinsics");
  sigma("readout_sigma", &options->readout_sigma);
  sigma("focal_length_sigma", &options->focal_length_sigma);
  sigma("principal_point_sigma", &options->principal_point_sigma);
  sigma("distortion_sigma", &options->distortion_sigma);
  sigma("imu_intrinsics_sigma", &options->imu_intrinsics_sigma);
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
  if (rolling_shutter_readout > 0.0 || estimate_readout)
    requireWithin("estimator", "image_height", image_height, kHeight);
  requireWithin("estimator", "extrinsic_rotation_sigma", extrinsic_rotation_sigma, kSigma);
  requireWithin("estimator", "extrinsic_translation_sigma", extrinsic_translation_sigma, kSigma);
  requireWithin("estimator", "td_sigma", td_sigma, kSigma);
  requireWithin("estimator", "readout_sigma", readout_sigma, kSigma);
  requireWithin("estimator", "focal_length_sigma", focal_length_sigma, kSigma);
  requireWithin("estimator", "principal_point_sigma", principal_point_sigma, kSigma);
  requireWithin("estimator", "distortion_sigma", distortion_sigma, kSigma);
  requireWithin("estimator", "imu_intrinsics_sigma", imu_intrinsics_sigma, kSigma);
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
             << "estimate_readout: " << options.estimate_readout
             << ", readout_sigma: " << options.readout_sigma << " s\n"
             << "estimate_intrinsics: " << options.estimate_intrinsics
             << ", focal_length_sigma: " << options.focal_length_sigma
             << ", principal_point_sigma: " << options.principal_point_sigma
             << ", distortion_sigma: " << options.distortion_sigma << "\n"
             << "estimate_imu_intrinsics: " << options.estimate_imu_intrinsics
             << ", imu_intrinsics_sigma: " << options.imu_intrinsics_sigma << "\n"
             << "motion_only_ba: " << static_cast<int>(options.motion_only) << "\n"
             << "pixel_noise: " << options.pixel_noise << " px\n"
             << "window_size: " << options.window_size << " keyframes\n"
             << "keyframe_parallax: " << options.keyframe_parallax << " px\n"
             << "min_tracks: " << options.min_tracks << "\n"
             << "max_num_iterations: " << options.max_num_iterations << "\n"
             << "max_solver_time: " << options.max_solver_time << " s\n"
             << "first_estimates: " << options.first_estimates << "\n";
}

EstimatorOptions readEstimatorOptions(const Parameters& parameters, const camera_model::Rig& rig) {
  const camera_model::RigCamera& camera = rig.cameras.front();
  EstimatorOptions options;
  options.imu = rig.imu.noise;
  options.extrinsic = rig.extrinsic;
  options.T_bc = camera.T_bc;
  options.td = camera.td;
  options.estimate_td = rig.estimate_td;
  options.rolling_shutter_readout = camera.readout;
  options.image_height = camera.camera->imageSize().height;
  options.motion_only = readMotionOnly(parameters);
  options.extrinsic_rotation_sigma =
      parameters.numberOr("extrinsic_rotation_sigma", options.extrinsic_rotation_sigma, kSigma);
  options.extrinsic_translation_sigma = parameters.numberOr(
      "extrinsic_translation_sigma", options.extrinsic_translation_sigma, kSigma);
  options.td_sigma = parameters.numberOr("td_sigma", options.td_sigma, kSigma);
  readSelfCalibration(parameters, &options);
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

}  // namespace vins::estimator
