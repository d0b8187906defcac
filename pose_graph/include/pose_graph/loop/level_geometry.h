#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vins_core/heading.h"

namespace vins::pose_graph {

/// Two views whose roll and pitch are known differ by a yaw and a translation. Everything here is
/// in level frames, whose z axis is upwards: turned so, that a yaw is all that is left of the
/// rotation between them.

/// A point that one view has measured, and the direction in which the other sees it.
struct LevelPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< from the query's body [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit vector from the old camera
};

/// Takes level coordinates of the query to those of the old view: R_z(yaw) p + translation.
struct YawTranslation {
  double yaw = 0.0;                                       ///< [rad]
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m], from the old camera

  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const {
    return yawRotation(yaw) * p + translation;
  }
};

/// Where the query stands, by two points: at most two solutions, with both points in the directions
/// in which they are seen; none where the points are one above the other or seen in one direction.
/// The problem of Z. Kukelova, M. Bujnak, T. Pajdla, "Closed-form solutions to minimal absolute
/// pose problems with known vertical direction", ACCV 2010. Here, with the directions d_i: the
/// points' difference lies in the plane of the directions, (d_1 x d_2) . R_z(yaw) (p_1 - p_2) = 0,
/// which is A cos(yaw) + B sin(yaw) + C = 0; the depths follow linearly.
std::vector<YawTranslation> solveTwoPoints(const LevelPoint& first, const LevelPoint& second);

/// One point, seen by both views.
struct LevelBearings {
  Eigen::Vector3d query = Eigen::Vector3d::UnitZ();  ///< unit vector from the query's camera
  Eigen::Vector3d old = Eigen::Vector3d::UnitZ();    ///< unit vector from the old camera
};

/// How bearings are turned, and in which direction the query's camera stands.
struct YawDirection {
  double yaw = 0.0;                                      ///< [rad]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit vector; its sign is not known
};

/// The motions that put three pairs of bearings into epipolar planes, with a yaw within
/// +-max_yaw [rad]: the problem of F. Fraundorfer, P. Tanskanen, M. Pollefeys, "A minimal case
/// solution to the calibrated relative pose problem for the case of known orientation angles", ECCV
/// 2010. The normals R_z(yaw) q_i x o_i lie in a plane where their determinant vanishes: its roots
/// are searched for along the yaw.
std::vector<YawDirection> solveThreeBearings(const std::array<LevelBearings, 3>& pairs,
                                             double max_yaw);

/// Sine of the angle between the old bearing and the epipolar plane of the query's; fades to zero
/// near the epipole, where any plane will do.
double epipolarError(const LevelBearings& pair, const YawDirection& motion);

}  // namespace vins::pose_graph
