#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "vins_core/pose.h"
#include "vins_estimator/inertial/nav_state.h"
#include "vins_estimator/inertial/preintegration.h"
#include "vins_estimator/initialization/joint_refinement.h"
#include "vins_estimator/initialization/visual_structure.h"

namespace vins::estimator {

/// Options of align().
struct AlignmentOptions {
  double max_gyroscope_bias = 0.3;      ///< [rad/s]
  double max_accelerometer_bias = 1.0;  ///< [m/s^2]
  double max_rotation_residual = 0.02;  ///< of the gyroscope against the images: rms [rad]
  double max_gravity_error = 0.1;       ///< of its length before that is fixed, share
  double max_linear_scale_sigma = 0.5;  ///< relative, of the linear solution
  double max_scale_sigma = 0.25;        ///< relative, of the joint refinement
  double max_visual_rms = 1.5;          ///< per axis [deviations]
  double max_imu_chi2 = 16.0;           ///< per degree of freedom
  double max_speed = 30.0;              ///< [m/s]
  int min_landmarks = 20;               ///< after the joint refinement
  JointRefinementOptions joint;

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

enum class AlignmentStatus {
  kOk,
  kGyroscopeDisagrees,  ///< no bias makes the gyroscope's rotations those of the images
  kLittleExcitation,    ///< the accelerations do not tell the scale well enough
  kGravityImplausible,  ///< what remains constant of the acceleration is not gravity
  kNotConverged,        ///< the joint refinement
  kBadResiduals,        ///< images and IMU contradict each other
  kImplausible          ///< speed or biases that no vehicle or sensor has
};

const char* toString(AlignmentStatus status);

/// States and landmarks in metres. With another status than kOk, only the figures so far.
struct Alignment {
  AlignmentStatus status = AlignmentStatus::kGyroscopeDisagrees;
  JointProblem solution;     ///< the world: gravity (0, 0, -g), the first body at the origin,
                             ///< without yaw (see levelRotation())
  double scale = 0.0;        ///< metres per unit of the structure
  double gravity = 0.0;      ///< length before it is fixed [m/s^2]
  double scale_sigma = 0.0;  ///< relative
  double visual_rms = 0.0;   ///< per axis [deviations]
  double imu_chi2 = 0.0;     ///< per degree of freedom
  Vector15d sigma = Vector15d::Zero();  ///< deviations of the first state's errors

  bool ok() const { return status == AlignmentStatus::kOk; }
};

/// The gyroscope's bias that brings the preintegrated rotations nearest to those of the images
/// (VINS-Mono, equation 15); nothing where they stay more than `max_residual` (rms [rad]) apart.
/// `R_sb`: body rotations; `imu[i]` from i-1 to i.
std::optional<Eigen::Vector3d> estimateGyroscopeBias(const std::vector<Eigen::Quaterniond>& R_sb,
                                                     std::vector<Preintegration> imu,
                                                     double max_residual);

/// First velocity, gravity and scale by linear least squares.
struct LinearAlignment {
  Eigen::Vector3d v_s = Eigen::Vector3d::Zero();  ///< of the first body, in the structure's frame
  Eigen::Vector3d g_s = Eigen::Vector3d::Zero();  ///< points down [m/s^2]
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  ///< [m/s^2]
  double scale = 0.0;                                            ///< metres per unit
  double scale_sigma = 0.0;     ///< relative, by the scatter of the camera positions
  double free_gravity = 0.0;    ///< length before it is fixed [m/s^2]
  double position_sigma = 0.0;  ///< scatter of the camera positions, per axis [unit]
};

/// The alignment's equations are those of VINS-Mono (its equations 17 to 19 and algorithm 1), put
/// together otherwise: the accelerations integrated twice along the whole path are the camera
/// positions, up to (1 / scale), first velocity, gravity and accelerometer bias, in which they are
/// linear. So the images, by far the less certain, stand on the side of the measurements; with them
/// among the coefficients the scale comes out too small, by up to a half over two seconds. First
/// gravity is free and there is no bias; then gravity keeps its length `gravity` and moves on the
/// tangent plane until its direction stands, with the bias about zero (deviation `bias_sigma`
/// [m/s^2]). Nothing where singular.
std::optional<LinearAlignment> alignLinearly(const std::vector<Pose>& T_sc, const Pose& T_bc,
                                             const std::vector<Preintegration>& imu, double gravity,
                                             double bias_sigma);

/// Chi-square that the IMU has added to that of the images alone, per degree of freedom that it
/// adds: about one or less where the two agree. `structure` and `solution`: before and after the
/// joint refinement, `squares` of the latter; sightings that it has rejected do not count.
double addedChiSquare(const VisualStructure& structure, const JointProblem& solution,
                      double squares);

/// Structure and IMU to metric states: gyroscope bias, linear alignment, joint refinement, and a
/// test of the whole: "a wrong scale accepted is worse than one more second of waiting". `imu[i]`
/// leads from frame i-1 to i, the first is empty.
Alignment align(const VisualStructure& structure, const std::vector<Preintegration>& imu,
                const Pose& T_bc, const AlignmentOptions& options);

}  // namespace vins::estimator
