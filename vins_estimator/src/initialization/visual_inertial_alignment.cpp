#include "vins_estimator/initialization/visual_inertial_alignment.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Cholesky>

#include "vins_core/option_check.h"
#include "vins_core/so3.h"
#include "vins_estimator/initialization/static_initializer.h"

namespace vins::estimator {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<Eigen::Quaterniond> bodyRotations(const std::vector<Pose>& T_sc, const Pose& T_bc) {
  std::vector<Eigen::Quaterniond> R_sb;
  for (const Pose& pose : T_sc) R_sb.push_back(pose.rotation * T_bc.rotation.conjugate());
  return R_sb;
}

/// States in the world as the IMU carries them on from the linear solution's first: the joint
/// refinement weighs the IMU far more than the images, so that this start is nearer to its end than
/// the structure's own poses.
std::vector<NavState> metricStates(const LinearAlignment& linear, const Eigen::Quaterniond& R_sb,
                                   const Vector3d& gyroscope_bias,
                                   const std::vector<Preintegration>& imu) {
  const Eigen::Quaterniond R_level =
      Eigen::Quaterniond::FromTwoVectors(linear.g_s, -Vector3d::UnitZ());
  const Eigen::Quaterniond R_ws = withoutYaw(R_level * R_sb) * R_sb.conjugate();
  NavState first;
  first.T_wb.rotation = (R_ws * R_sb).normalized();
  first.v_w = R_ws * linear.v_s;
  first.accelerometer_bias = linear.accelerometer_bias;
  first.gyroscope_bias = gyroscope_bias;
  std::vector<NavState> states = {first};
  const Vector3d g_w(0.0, 0.0, -imu.back().noise().gravity);
  for (std::size_t i = 1; i < imu.size(); ++i) {
    states.push_back(imu[i].predict(states.back(), g_w));
  }
  return states;
}

std::vector<InitialLandmark> metricLandmarks(std::vector<InitialLandmark> landmarks, double scale) {
  for (InitialLandmark& landmark : landmarks) landmark.parameters.z() /= scale;
  return landmarks;
}

/// The refinement keeps the first position and yaw to some micrometres; this is exact.
void moveToConvention(std::vector<NavState>* states) {
  const Pose first = states->front().T_wb;
  const Eigen::Quaterniond turn = withoutYaw(first.rotation) * first.rotation.conjugate();
  for (NavState& state : *states) {
    state.T_wb.position = turn * (state.T_wb.position - first.position);
    state.T_wb.rotation = (turn * state.T_wb.rotation).normalized();
    state.v_w = turn * state.v_w;
  }
}

/// The landmarks of `structure` with the sightings that are left in `kept`; both by rising id.
std::vector<InitialLandmark> restricted(const std::vector<InitialLandmark>& structure,
                                        const std::vector<InitialLandmark>& kept) {
  std::vector<InitialLandmark> result;
  auto original = structure.begin();
  for (const InitialLandmark& landmark : kept) {
    while (original->id < landmark.id) ++original;
    result.push_back(*original);
    result.back().sightings = landmark.sightings;
  }
  return result;
}

/// Each interval has nine equations besides the walk of the biases; velocities, biases, scale and
/// gravity's direction are found from them.
double imuDegrees(std::size_t frames) {
  const auto n = static_cast<double>(frames);
  return std::max(6.0, 9.0 * (n - 1.0) - 3.0 * n - 9.0);
}

bool isPlausible(const std::vector<NavState>& states, const AlignmentOptions& options) {
  return std::all_of(states.begin(), states.end(), [&](const NavState& state) {
    return isFinite(state) && state.v_w.norm() <= options.max_speed &&
           state.accelerometer_bias.norm() <= options.max_accelerometer_bias &&
           state.gyroscope_bias.norm() <= options.max_gyroscope_bias;
  });
}

AlignmentStatus judgeLinear(const LinearAlignment& linear, double gravity,
                            const AlignmentOptions& options) {
  // A scale that is not even positive: the accelerations say nothing against their noise.
  if (!(linear.scale > 0.0) || linear.scale_sigma > options.max_linear_scale_sigma) {
    return AlignmentStatus::kLittleExcitation;
  }
  const bool plausible =
      std::abs(linear.free_gravity - gravity) <= options.max_gravity_error * gravity;
  return plausible ? AlignmentStatus::kOk : AlignmentStatus::kGravityImplausible;
}

AlignmentStatus judge(const Alignment& alignment, bool converged, const AlignmentOptions& options) {
  if (!converged) return AlignmentStatus::kNotConverged;
  const bool residuals_good =
      alignment.visual_rms <= options.max_visual_rms &&
      alignment.imu_chi2 <= options.max_imu_chi2 &&
      static_cast<int>(alignment.solution.landmarks.size()) >= options.min_landmarks;
  if (!residuals_good) return AlignmentStatus::kBadResiduals;
  if (!(alignment.scale_sigma <= options.max_scale_sigma)) {
    return AlignmentStatus::kLittleExcitation;
  }
  return isPlausible(alignment.solution.states, options) ? AlignmentStatus::kOk
                                                         : AlignmentStatus::kImplausible;
}

}  // namespace

void AlignmentOptions::validate() const {
  const std::pair<const char*, double> positive[] = {
      {"max_gyroscope_bias", max_gyroscope_bias},
      {"max_accelerometer_bias", max_accelerometer_bias},
      {"max_rotation_residual", max_rotation_residual},
      {"max_gravity_error", max_gravity_error},
      {"max_linear_scale_sigma", max_linear_scale_sigma},
      {"max_scale_sigma", max_scale_sigma},
      {"max_visual_rms", max_visual_rms},
      {"max_imu_chi2", max_imu_chi2},
      {"max_speed", max_speed},
      {"min_landmarks", min_landmarks}};
  for (const auto& [name, value] : positive) requirePositive("alignment", name, value);
  joint.validate();
}

const char* toString(AlignmentStatus status) {
  switch (status) {
    case AlignmentStatus::kOk:
      return "ok";
    case AlignmentStatus::kGyroscopeDisagrees:
      return "gyroscope disagrees";
    case AlignmentStatus::kLittleExcitation:
      return "little excitation";
    case AlignmentStatus::kGravityImplausible:
      return "gravity implausible";
    case AlignmentStatus::kNotConverged:
      return "not converged";
    case AlignmentStatus::kBadResiduals:
      return "bad residuals";
    case AlignmentStatus::kImplausible:
      return "implausible";
  }
  return "unknown";
}

std::optional<Vector3d> estimateGyroscopeBias(const std::vector<Eigen::Quaterniond>& R_sb,
                                              std::vector<Preintegration> imu,
                                              double max_residual) {
  constexpr int kIterations = 3;
  Vector3d bias = imu.back().gyroscopeBias();
  double squares = 0.0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Matrix3d H = Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    squares = 0.0;
    for (std::size_t i = 1; i < imu.size(); ++i) {
      imu[i].reintegrate(imu[i].accelerometerBias(), bias);
      const Matrix3d J = imu[i].jacobian().block<3, 3>(kRotation, kGyrBias);
      const Vector3d residual =
          so3::log(imu[i].gamma().conjugate() * (R_sb[i - 1].conjugate() * R_sb[i]));
      H += J.transpose() * J;
      g += J.transpose() * residual;
      squares += residual.squaredNorm();
    }
    const Vector3d step = H.ldlt().solve(g);
    if (!step.allFinite()) return std::nullopt;
    // The last pass only measures what is left.
    if (iteration + 1 < kIterations) bias += step;
  }
  if (std::sqrt(squares / static_cast<double>(imu.size() - 1)) > max_residual) return std::nullopt;
  return bias;
}

double addedChiSquare(const VisualStructure& structure, const JointProblem& solution,
                      double squares) {
  std::vector<NavState> cameras;
  for (const Pose& T_sc : structure.T_sc) {
    cameras.emplace_back();
    cameras.back().T_wb = T_sc;
  }
  const double visual = landmarkSquares(Pose(), InitialBlocks(cameras),
                                        restricted(structure.landmarks, solution.landmarks));
  return (squares - visual) / imuDegrees(cameras.size());
}

Alignment align(const VisualStructure& structure, const std::vector<Preintegration>& imu,
                const Pose& T_bc, const AlignmentOptions& options) {
  Alignment alignment;
  const auto R_sb = bodyRotations(structure.T_sc, T_bc);
  const auto gyroscope_bias = estimateGyroscopeBias(R_sb, imu, options.max_rotation_residual);
  if (!gyroscope_bias || gyroscope_bias->norm() > options.max_gyroscope_bias) return alignment;

  JointProblem& solution = alignment.solution;
  solution.imu = imu;
  solution.T_bc = T_bc;
  for (Preintegration& interval : solution.imu) {
    interval.reintegrate(Vector3d::Zero(), *gyroscope_bias);
  }
  const double gravity = imu.back().noise().gravity;
  const auto linear = alignLinearly(structure.T_sc, T_bc, solution.imu, gravity,
                                    options.joint.accelerometer_bias_sigma);
  alignment.status = AlignmentStatus::kLittleExcitation;
  if (!linear) return alignment;
  alignment.scale = linear->scale;
  alignment.gravity = linear->free_gravity;
  alignment.scale_sigma = linear->scale_sigma;
  alignment.status = judgeLinear(*linear, gravity, options);
  if (!alignment.ok()) return alignment;

  solution.states = metricStates(*linear, R_sb.front(), *gyroscope_bias, solution.imu);
  solution.landmarks = metricLandmarks(structure.landmarks, linear->scale);
  const JointRefinement joint = refineJointly(options.joint, &solution);
  alignment.visual_rms = joint.visual_rms;
  alignment.imu_chi2 = addedChiSquare(structure, solution, joint.squares);
  const double misfit =
      std::sqrt(std::max({1.0, alignment.imu_chi2, std::pow(joint.visual_rms, 2)}));
  alignment.scale_sigma = misfit * joint.scale_sigma;
  alignment.sigma = misfit * joint.sigma;
  alignment.status = judge(alignment, joint.converged, options);
  if (alignment.ok()) moveToConvention(&solution.states);
  return alignment;
}

}  // namespace vins::estimator
