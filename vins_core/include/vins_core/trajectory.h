#pragma once

#include <optional>
#include <vector>

#include "vins_core/pose.h"
#include "vins_core/time.h"

namespace vins {

/// Where the body stood at one time.
struct StampedPose {
  Stamp stamp = 0;  ///< [ns]
  Pose T_wb;
};

/// Poses in the order of time.
class Trajectory {
 public:
  Trajectory() = default;

  /// Takes poses with strictly rising stamps; throws InputError naming the first stamp that is not.
  explicit Trajectory(const std::vector<StampedPose>& poses);

  /// Appends a pose; throws InputError if its stamp is not above the last one.
  void append(const StampedPose& pose);

  const std::vector<StampedPose>& poses() const { return poses_; }
  bool empty() const { return poses_.empty(); }

  /// From the first stamp to the last [s]; 0 when empty.
  double duration() const;

  /// Sum of the distances between neighbouring positions [m].
  double length() const;

  /// Pose at a time between two poses at most `max_gap` [s] apart: positions linearly, rotations
  /// along the shortest arc (slerp). Nothing outside of the poses or inside a larger gap.
  std::optional<Pose> interpolate(Stamp stamp, double max_gap) const;

 private:
  std::vector<StampedPose> poses_;
};

}  // namespace vins
