#include "simulation/moving_objects.h"

#include <algorithm>
#include <vector>

#include "simulation/random.h"
#include "simulation/scene_catalogue.h"
#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;

constexpr int kTries = 2000;
constexpr double kClearance = 0.6;  ///< [m]

std::vector<Vector3d> samplePath(const TrajectorySpline& trajectory, double begin_s, double end_s) {
  std::vector<Vector3d> path;
  for (double t = begin_s; t <= end_s; t += 0.1) path.push_back(trajectory.poseAt(t).position);
  return path;
}

/// What makeSwingingBlock() needs: where it swings, how, and how large it is.
struct Plan {
  Vector3d middle_w, swing, half;
  double period_s;

  Eigen::AlignedBox3d reach() const {
    const Vector3d size = half + swing.cwiseAbs();
    return {middle_w - size, middle_w + size};
  }
};

bool keepsClear(const Eigen::AlignedBox3d& reach, const Scene& scene,
                const std::vector<Vector3d>& path) {
  if (!scene.interior().contains(reach)) return false;
  return std::all_of(path.begin(), path.end(),
                     [&](const Vector3d& p_w) { return reach.exteriorDistance(p_w) > kClearance; });
}

/// A block in front of the camera at some time, swinging from side to side of it.
Plan randomPlan(const TrajectorySpline& trajectory, const Pose& T_bc, double begin_s, double end_s,
                Random* random) {
  const Pose T_wc = trajectory.poseAt(random->uniform(begin_s, end_s)) * T_bc;
  Plan plan;
  plan.middle_w = T_wc * Vector3d(0.0, 0.0, random->uniform(1.8, 4.0));
  plan.swing = random->uniform(0.4, 1.2) * (T_wc.rotation * Vector3d::UnitX());
  for (int i = 0; i < 3; ++i) plan.half[i] = random->uniform(0.25, 0.5);
  plan.period_s = random->uniform(4.0, 9.0);
  return plan;
}

}  // namespace

Scene withMovingObjects(const Scene& scene, int count, const TrajectorySpline& trajectory,
                        const Pose& T_bc, double begin_s, double end_s, std::uint64_t seed) {
  const std::vector<Vector3d> path = samplePath(trajectory, begin_s, end_s);
  Random random(seed, "moving objects");
  Scene filled = scene;
  int placed = 0;
  for (int tries = 0; placed < count; ++tries) {
    if (tries == kTries) {
      throw InputError("moving objects: found room for " + std::to_string(placed) + " of " +
                       std::to_string(count) + " beside the trajectory; allowed: fewer");
    }
    const Plan plan = randomPlan(trajectory, T_bc, begin_s, end_s, &random);
    if (!keepsClear(plan.reach(), scene, path)) continue;
    filled = filled.with(
        makeSwingingBlock(plan.middle_w, plan.swing, plan.period_s, plan.half, random.bits()));
    ++placed;
  }
  return filled;
}

}  // namespace vins::simulation
