#pragma once

#include <vector>

#include <Eigen/Core>

#include "vins_core/pose.h"
#include "vins_estimator/factors/bearing_factor.h"

namespace vins::estimator {

/// One ray on which a landmark has been seen.
struct TriangulationView {
  Pose T_wc;                                           ///< the camera in the world
  Eigen::Vector3d bearing = Eigen::Vector3d::UnitZ();  ///< unit, in the camera
  double inverse_sigma = 460.0;                        ///< weight of the bearing [1/rad]
};

struct TriangulationOptions {
  double min_parallax = 0.01;    ///< between the two rays most apart [rad]
  double max_rms = 3.0;          ///< of the weighted residuals per axis [deviations]
  double min_distance = 0.05;    ///< from the host's camera [m]
  double max_distance = 1000.0;  ///< from the host's camera [m]
  int max_iterations = 6;        ///< of Gauss-Newton

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

enum class TriangulationStatus {
  kOk,
  kTooFewViews,     ///< fewer than two
  kLittleParallax,  ///< the rays are too parallel to tell the distance
  kBehindCamera,    ///< not in front of each camera
  kBadDistance,     ///< nearer or farther than allowed
  kBadResidual      ///< the rays do not meet
};

/// "ok", "little parallax", ...
const char* toString(TriangulationStatus status);

/// A landmark and how good it is. With kBadResidual and kBadDistance all members are set; before,
/// only `parallax`.
struct Triangulation {
  TriangulationStatus status = TriangulationStatus::kTooFewViews;
  Eigen::Vector3d position_w = Eigen::Vector3d::Zero();      ///< [m]
  double distance = 0.0;                                     ///< from the host's camera [m]
  LandmarkParameters landmark = LandmarkParameters::Zero();  ///< (u, v, rho), see LandmarkAnchor
  double parallax = 0.0;                ///< angle between the two rays most apart [rad]
  double rms = 0.0;                     ///< of the weighted residuals per axis [deviations]
  double sigma_inverse_distance = 0.0;  ///< deviation of rho, the poses being exact [1/m]

  bool ok() const { return status == TriangulationStatus::kOk; }
};

/// Largest angle between two of the rays, in the world [rad].
double largestParallax(const std::vector<TriangulationView>& views);

/// Where the rays meet. The first view is the host; (u, v, rho) belong to its bearing and to
/// tangentBasis() of that. Begins with the point nearest to all rays (linear), then Gauss-Newton on
/// the bearings' tangent planes in (u, v, rho), whose cost is nearly quadratic for far points, too
/// (J. Montiel, J. Civera, A. Davison, "Unified inverse depth parametrization", RSS 2006).
Triangulation triangulate(const std::vector<TriangulationView>& views,
                          const TriangulationOptions& options = {});

}  // namespace vins::estimator
