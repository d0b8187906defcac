#include "simulation/tile_culling.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace vins::simulation {
namespace {

/// Planes about the cone; a panel with all corners beyond one of them is not met.
struct ConePlanes {
  Eigen::Vector3d normals[4];

  ConePlanes(const Eigen::Vector3d& axis, double cos_half, double sin_half) {
    const Eigen::Vector3d e1 = axis.unitOrthogonal(), e2 = axis.cross(e1);
    // The ray at half_angle from the axis towards -e lies just in the plane.
    normals[0] = sin_half * axis + cos_half * e1;
    normals[1] = sin_half * axis - cos_half * e1;
    normals[2] = sin_half * axis + cos_half * e2;
    normals[3] = sin_half * axis - cos_half * e2;
  }

  bool exclude(const Eigen::Vector3d (&corners)[4], double motion) const {
    for (const Eigen::Vector3d& normal : normals) {
      if (std::all_of(std::begin(corners), std::end(corners), [&](const Eigen::Vector3d& corner) {
            return normal.dot(corner) < -motion;
          })) {
        return true;
      }
    }
    return false;
  }
};

}  // namespace

TileCone TileCone::around(const RayGrid& rays, int u, int v) {
  const int last_u = std::min(u + kTileSize, rays.width());
  const int last_v = std::min(v + kTileSize, rays.height());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int y = v - 1; y <= last_v; ++y) {
    for (int x = u - 1; x <= last_u; ++x) sum += rays.bearing(x, y).cast<double>();
  }
  TileCone cone;
  if (sum.isZero(0.0)) return cone;
  cone.axis = sum.normalized();
  for (int y = v - 1; y <= last_v; ++y) {
    for (int x = u - 1; x <= last_u; ++x) {
      if (!rays.isSeen(x, y)) continue;
      const Eigen::Vector3d bearing = rays.bearing(x, y).cast<double>();
      const double angle = std::atan2(cone.axis.cross(bearing).norm(), cone.axis.dot(bearing));
      cone.half_angle = std::max(cone.half_angle, angle);
    }
  }
  cone.half_angle += 1e-6;  // the bearings are floats
  return cone;
}

TileCulling::TileCulling(const std::vector<PanelGeometry>& panels, const Eigen::Vector3d& p_wc,
                         const std::vector<double>& motion) {
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const PanelGeometry& panel = panels[i];
    const Eigen::Vector3d to_centre = panel.centre - p_wc;
    const double height = -to_centre.dot(panel.normal);
    if (height < -motion[i]) continue;
    Seen seen;
    seen.panel = static_cast<int>(i);
    const double distance = to_centre.norm(), radius = panel.radius + motion[i];
    seen.direction = to_centre / std::max(distance, 1e-9);
    seen.normal = panel.normal;
    seen.height = std::max(height - motion[i], 0.0);
    seen.min_distance = std::max(distance - radius, 0.0);
    seen.sin_size = distance > radius ? radius / distance : 0.0;
    seen.cos_size = distance > radius ? std::sqrt(1.0 - seen.sin_size * seen.sin_size) : -1.0;
    for (int corner = 0; corner < 4; ++corner) {
      seen.corners[corner] = to_centre + (corner & 1 ? 1.0 : -1.0) * panel.half_s * panel.axis_s +
                             (corner & 2 ? 1.0 : -1.0) * panel.half_t * panel.axis_t;
    }
    seen.motion = motion[i];
    seen_.push_back(seen);
  }
}

bool TileCulling::mayMeetSphere(const Seen& seen, const Eigen::Vector3d& axis, double cos_half,
                                double sin_half) {
  // cos(half angle + size) where the two are below pi together; cos_size is -1 around the camera.
  const double cos_sum = cos_half * seen.cos_size - sin_half * seen.sin_size;
  return seen.cos_size < 0.0 || seen.direction.dot(axis) >= cos_sum;
}

void TileCulling::candidates(const Eigen::Vector3d& axis_w, double half_angle,
                             std::vector<Candidate>& result) const {
  const double cos_half = std::cos(half_angle), sin_half = std::sin(half_angle);
  const ConePlanes planes(axis_w, cos_half, sin_half);
  result.clear();
  for (const Seen& seen : seen_) {
    if (!mayMeetSphere(seen, axis_w, cos_half, sin_half)) continue;
    if (planes.exclude(seen.corners, seen.motion)) continue;
    // The steepest ray of the cone towards the panel's plane meets it first.
    const double cos_tilt = -axis_w.dot(seen.normal);
    const double sin_tilt = std::sqrt(std::max(1.0 - cos_tilt * cos_tilt, 0.0));
    const double steepest = cos_tilt >= cos_half ? 1.0 : cos_tilt * cos_half + sin_tilt * sin_half;
    if (steepest <= 0.0) continue;
    const double distance = std::max(seen.height / steepest, seen.min_distance);
    // Rounded down: the rays are floats.
    result.push_back({seen.panel, static_cast<float>(0.9999 * distance - 1e-4)});
  }
  std::sort(result.begin(), result.end(), [](const Candidate& a, const Candidate& b) {
    return a.min_distance != b.min_distance ? a.min_distance < b.min_distance : a.panel < b.panel;
  });
}

}  // namespace vins::simulation
