#include "vins_estimator/health/rest_check.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "vins_core/so3.h"

namespace vins::estimator {

bool looksTheSame(const Landmarks& landmarks, FrameId a, FrameId b, double max_shift,
                  int min_shared) {
  // The small turn that takes the bearings of a to those of b, by least squares in pixels.
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  double resolution = 0.0;
  double noise = 0.0;  // deviation of a bearing, summed [rad]
  int shared = 0;
  for (const auto& [id, track] : landmarks.tracks()) {
    const TrackObservation* in_a = track.observationIn(a);
    const TrackObservation* in_b = track.observationIn(b);
    if (in_a == nullptr || in_b == nullptr) continue;
    const Eigen::Matrix3d hat = so3::hat(in_a->measured.bearing);
    H += hat.transpose() * hat;
    g += hat.transpose() * (in_a->measured.bearing - in_b->measured.bearing);
    resolution += in_b->angular_resolution;
    noise += 1.0 / in_b->measured.inverse_sigma;
    ++shared;
  }
  if (shared < min_shared) return false;
  const Eigen::Vector3d turn = H.ldlt().solve(g);
  // What noise may feign: three deviations of the mean of two images' difference.
  const double feigned = 3.0 * noise * std::sqrt(2.0 / shared);
  return turn.norm() * shared <= max_shift * resolution + feigned;
}

}  // namespace vins::estimator
