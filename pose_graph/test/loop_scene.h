#pragma once

#include <cmath>
#include <map>
#include <random>

#include "pose_graph/place/keyframe_view.h"
#include "random_descriptors.h"
#include "vins_core/so3.h"

namespace vins::pose_graph::testing {

/// A place seen twice: points about the origin of the world, an old keyframe, and a query's, each a
/// rig with a camera that looks along its body's x axis.
struct LoopScene {
  double yaw = 0.2;                             ///< of the query against the old body [rad]
  Eigen::Vector3d p_old_query{0.6, -0.4, 0.2};  ///< [m], in the old body's level frame
  Eigen::Vector3d tilt_old{0.05, -0.1, 0.0}, tilt_query{-0.08, 0.06, 0.0};  ///< [rad]
  double drift_yaw = 0.0;  ///< of the query's odometry against the old one's [rad]
  Eigen::Vector3d gravity_error = Eigen::Vector3d::Zero();  ///< of the query's odometry [rad]
  double noise = 0.5;                                       ///< of bearings [px]
  double depth_noise = 0.03;                                ///< of the query's points, relative
  int good = 80;                                            ///< points that both see
  int wrong = 0;                                            ///< matches that are none
  double half_angle = 0.6;  ///< of the cone that the camera sees [rad]
  unsigned seed = 1;

  static constexpr double kPixel = 1.0 / 460.0;  ///< [rad]

  Eigen::Quaterniond rotationOld() const { return so3::exp(tilt_old); }
  Eigen::Quaterniond rotationQuery() const {
    return so3::exp(Eigen::Vector3d(0, 0, yaw)) * so3::exp(tilt_query);
  }
  Pose truth() const {
    return Pose(rotationOld(), Eigen::Vector3d::Zero()).inverse() *
           Pose(rotationQuery(), p_old_query);
  }
  static Pose cameraInBody() {
    // Camera z along body x, camera y down.
    Eigen::Matrix3d R;
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    return {Eigen::Quaterniond(R), {0.05, 0.02, -0.01}};
  }

  struct Views {
    KeyframeView query, old;
  };

  Views views() const {
    std::mt19937_64 random(seed);
    Views views;
    views.old.id = 3;
    views.query.id = 40;
    views.old.R_wb = rotationOld();
    views.query.R_wb =
        so3::exp(Eigen::Vector3d(0, 0, drift_yaw)) * so3::exp(gravity_error) * rotationQuery();
    views.old.T_bc = views.query.T_bc = cameraInBody();
    views.old.pixel_angle = views.query.pixel_angle = kPixel;
    for (int i = 0; i < good + wrong; ++i) addPoint(i >= good, &random, &views);
    // Corners that the other view does not have.
    for (int i = 0; i < 300; ++i) {
      views.old.features.push_back(
          feature(randomDirection(&random), randomDescriptor(&random), -1));
    }
    return views;
  }

 private:
  Eigen::Vector3d randomDirection(std::mt19937_64* random) const {
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const double angle = half_angle * std::sqrt(uniform(*random)),
                 around = 6.28319 * uniform(*random);
    return {std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around),
            std::cos(angle)};
  }

  Eigen::Vector3d noisy(const Eigen::Vector3d& direction, std::mt19937_64* random) const {
    std::normal_distribution<double> normal(0.0, noise * kPixel);
    const Eigen::Vector3d side = direction.unitOrthogonal();
    return (direction + normal(*random) * side + normal(*random) * direction.cross(side))
        .normalized();
  }

  static ViewFeature feature(const Eigen::Vector3d& bearing, const BriefDescriptor& descriptor,
                             int point) {
    ViewFeature feature;
    feature.bearing = bearing.cast<float>();
    feature.pixel = (bearing.head<2>() / std::max(0.1, bearing.z()) * 460.0).cast<float>() +
                    Eigen::Vector2f(376, 240);
    feature.descriptor = descriptor;
    feature.point = point;
    return feature;
  }

  void addPoint(bool is_wrong, std::mt19937_64* random, Views* views) const {
    std::uniform_real_distribution<double> depth(2.0, 8.0);
    std::normal_distribution<double> normal(0.0, 1.0);
    const Eigen::Vector3d direction = randomDirection(random);
    const Eigen::Vector3d p_q = cameraInBody() * (depth(*random) * direction);
    const Eigen::Vector3d p_c = cameraInBody().inverse() * (truth() * p_q);
    const Eigen::Vector3d seen = is_wrong ? randomDirection(random) : p_c.normalized();
    const BriefDescriptor descriptor = randomDescriptor(random);
    const int index = static_cast<int>(views->query.points.size());
    views->query.points.push_back({500 + index, p_q * (1.0 + depth_noise * normal(*random))});
    views->query.features.push_back(feature(noisy(direction, random), descriptor, index));
    views->old.features.push_back(
        feature(noisy(seen, random), withNoise(descriptor, 20, random), -1));
  }
};

}  // namespace vins::pose_graph::testing
