#include "simulation/rig.h"

#include <cmath>
#include <sstream>

#include "camera_model/camera_file.h"
#include "simulation/random.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"
#include "vins_core/yaml_text.h"

namespace vins::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

bool isOneOf(const std::string& name, const std::vector<std::string>& names) {
  for (const std::string& other : names) {
    if (name == other) return true;
  }
  return false;
}

/// Deviation of a parameter's error at one sigma.
double parameterDeviation(const std::string& name, double value) {
  // Of a Scaramuzza camera p0 is the focal length and ac the ratio of the axes.
  if (isOneOf(name, {"fx", "fy", "mu", "mv", "gamma1", "gamma2", "p0", "ac"})) {
    return 0.001 * std::abs(value);
  }
  if (isOneOf(name, {"cx", "cy", "u0", "v0"})) return 0.5;
  return 0.01 * std::abs(value);
}

std::shared_ptr<const camera_model::Camera> perturbed(const camera_model::Camera& camera,
                                                      double sigmas, Random* random) {
  camera_model::CameraParameters parameters = camera.parameters();
  const std::vector<std::string> names = camera.parameterNames();
  for (Eigen::Index i = 0; i < parameters.size(); ++i) {
    const double deviation = parameterDeviation(names[static_cast<std::size_t>(i)], parameters[i]);
    parameters[i] += sigmas * deviation * random->normal();
  }
  return camera.withParameters(parameters);
}

/// Keys of VINS-Mono that have nothing to do with the rig, at the values of its EuRoC example but
/// for freq: every frame is used.
constexpr char kTrackerAndSolver[] = R"(
# Feature tracker
max_cnt: 150
min_dist: 30
freq: 0
F_threshold: 1.0
show_track: 1
equalize: 1
fisheye: 0

# Solver
max_solver_time: 0.04
max_num_iterations: 8
keyframe_parallax: 10.0
)";

constexpr char kLoopAndMap[] = R"(
# Loop closure and map
loop_closure: 1
load_previous_pose_graph: 0
fast_relocalization: 1
pose_graph_save_path: "/tmp/vins_output/pose_graph/"
save_image: 0
visualize_imu_forward: 0
visualize_camera_size: 0.4
)";

std::string imuText(const Rig& rig) {
  return "\n# IMU: densities [m/s^2/sqrt(Hz)], [rad/s/sqrt(Hz)], [m/s^3/sqrt(Hz)], "
         "[rad/s^2/sqrt(Hz)]; gravity [m/s^2]\n"
         "acc_n: " +
         exactNumber(rig.noise.accelerometer_noise) +
         "\ngyr_n: " + exactNumber(rig.noise.gyroscope_noise) +
         "\nacc_w: " + exactNumber(rig.noise.accelerometer_walk) +
         "\ngyr_w: " + exactNumber(rig.noise.gyroscope_walk) +
         "\ng_norm: " + exactNumber(rig.noise.gravity) + "\n";
}

std::string timingText(const Rig& rig) {
  std::ostringstream text;
  text << "\n# Timing: t_imu = t_cam + td [s]; read-out of all rows [s]\n"
       << "estimate_td: " << rig.estimate_time_offset << "\ntd: " << exactNumber(rig.time_offset)
       << "\nrolling_shutter: " << (rig.rolling_shutter_readout > 0.0)
       << "\nrolling_shutter_tr: " << exactNumber(rig.rolling_shutter_readout) << "\n";
  if (rig.self_calibration) {
    text << "estimate_readout: 1\nestimate_intrinsics: 1\nestimate_imu_intrinsics: 1\n";
  }
  return text.str();
}

}  // namespace

Rig withCalibrationError(const Rig& rig, double sigmas, std::uint64_t seed) {
  if (!std::isfinite(sigmas) || sigmas < 0.0) {
    throw InputError("calibration error: found " + exactNumber(sigmas) +
                     "; allowed: a number of sigmas of at least 0");
  }
  if (sigmas == 0.0) return rig;
  Random random(seed, "calibration error");
  Rig erring = rig;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    erring.cameras[i] = perturbed(*rig.cameras[i], sigmas, &random);
    const Eigen::Vector3d turn = 0.2 * kDegree * sigmas * random.normal3();
    erring.T_bc[i].rotation = (rig.T_bc[i].rotation * so3::exp(turn)).normalized();
    erring.T_bc[i].position += 0.002 * sigmas * random.normal3();
  }
  erring.estimate_extrinsic = true;
  return erring;
}

std::string toVinsYaml(const Rig& rig, std::size_t camera) {
  // YAML's head comes with the camera, which therefore stands first.
  return camera_model::toCamodocalYaml(*rig.cameras[camera]) +
         "\n# Topics and results\nimu_topic: \"/imu0\"\n" + "image_topic: \"/cam" +
         std::to_string(camera) + "/image_raw\"\noutput_path: \"/tmp/vins_output/\"\n" +
         "\n# Camera in the body (IMU) frame; 0: trust it, 1: refine it\nestimate_extrinsic: " +
         (rig.estimate_extrinsic ? "1" : "0") + "\n" +
         opencvMatrix("extrinsicRotation", rig.T_bc[camera].rotation.toRotationMatrix()) +
         opencvMatrix("extrinsicTranslation", rig.T_bc[camera].position) + kTrackerAndSolver +
         imuText(rig) + timingText(rig) + kLoopAndMap;
}

}  // namespace vins::simulation
