#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "pose_graph/place/keyframe_view.h"
#include "pose_graph/place/place_model.h"
#include "vins_core/keyframe.h"

namespace vins::pose_graph {

/// What a walk through the town is like.
struct TownWalkOptions {
  double lap = 1000.0;            ///< length of the round road [m]
  double speed = 1.39;            ///< 5 km an hour [m/s]
  double sway = 0.6;              ///< to both sides, and a sixth of it up and down [m]
  double period = 0.5;            ///< between keyframes [s]
  double landmarks = 50.0;        ///< on either side of the road together [1/m]
  std::size_t points = 120;       ///< features of a view that have a depth
  double pixel_noise = 0.5;       ///< [px]
  double depth_noise = 0.02;      ///< relative
  int descriptor_noise = 12;      ///< bits turned each time a landmark is seen
  double position_drift = 0.005;  ///< of the odometry [m/sqrt(s)]
  double yaw_drift = 0.0005;      ///< of the odometry [rad/sqrt(s)]
  std::uint64_t seed = 1;
};

/// A keyframe as the pose graph gets it, without an image.
struct TownKeyframe {
  Keyframe keyframe;
  DescribedView described;
  Pose truth;  ///< body in the town
};

/// A walk round and round a town whose landmarks have descriptors of their own: keyframes, with
/// views such as ViewDescriber makes, at no cost of rendering. The path sways from lap to lap.
class TownWalk {
 public:
  explicit TownWalk(const TownWalkOptions& options);

  /// Of the town's landmarks; the pattern belongs to no image.
  const PlaceModel& places() const { return places_; }

  /// The next keyframe; ids count from 0.
  TownKeyframe next();

 private:
  struct Landmark {
    Eigen::Vector3d position;
    BriefDescriptor descriptor;
  };

  Pose truthAt(double distance) const;
  void drift();
  double normal(double sigma);
  BriefDescriptor seen(BriefDescriptor descriptor);
  KeyframeView viewFrom(const Pose& T_tb, double distance);
  void addFeature(std::size_t landmark, const Eigen::Vector3d& p_b, KeyframeView* view);

  TownWalkOptions options_;
  std::mt19937_64 random_;
  std::vector<Landmark> landmarks_;  ///< along the road
  PlaceModel places_;
  Pose T_wt_;  ///< odometry's world <- town
  std::int64_t next_id_ = 0;
};

}  // namespace vins::pose_graph
