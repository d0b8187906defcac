#pragma once

#include <vector>

#include <Eigen/Core>

#include "simulation/panel_view.h"
#include "simulation/ray_grid.h"

namespace vins::simulation {

/// Side of the squares of pixels that are rendered together.
constexpr int kTileSize = 16;

/// A cone about all bearings of a tile and of the pixels next to it, in the camera frame.
struct TileCone {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double half_angle = -1.0;  ///< [rad]; negative where the tile has no bearing

  /// Of the tile whose upper left pixel is (u, v).
  static TileCone around(const RayGrid& rays, int u, int v);
};

/// Finds the panels that the rays of a tile may meet, seen from one place.
class TileCulling {
 public:
  /// `motion[i]`: how far any point of panel i, relative to the camera's centre, strays from its
  /// place in `panels` [m].
  TileCulling(const std::vector<PanelGeometry>& panels, const Eigen::Vector3d& p_wc,
              const std::vector<double>& motion);

  /// Candidates for rays in a cone (axis in the world, half angle [rad] below pi / 2), nearest
  /// first.
  void candidates(const Eigen::Vector3d& axis_w, double half_angle,
                  std::vector<Candidate>& result) const;

 private:
  struct Seen {
    int panel;
    Eigen::Vector3d direction;  ///< to the centre, unit
    Eigen::Vector3d normal;
    double height;               ///< of the camera above the panel's plane, at least [m]
    double min_distance;         ///< of the sphere around the panel [m]
    double cos_size, sin_size;   ///< of the angle that the sphere subtends, from its centre
    Eigen::Vector3d corners[4];  ///< relative to the camera [m]
    double motion;               ///< [m]
  };
  static bool mayMeetSphere(const Seen& seen, const Eigen::Vector3d& axis, double cos_half,
                            double sin_half);

  std::vector<Seen> seen_;
};

}  // namespace vins::simulation
