#include "simulation/builtin_trajectories.h"

#include <cmath>
#include <functional>
#include <memory>
#include <sstream>

#include "simulation/closed_path.h"
#include "simulation/motion_design.h"
#include "simulation/walking_motion.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kMargin = 1.0;           ///< known before the start and after the end [s]
constexpr double kRest = 0.3;             ///< at the start and at the end [s]
constexpr double kDegree = M_PI / 180.0;  ///< [rad]

/// What a name stands for: where to be and look at each time, and how coarsely that is smoothed.
struct Design {
  std::function<DesignedPose(double t)> at;
  double knot_interval = 0.1;  ///< [s]
  bool of_camera = false;      ///< positions are the camera's, not the body's
  bool leans = true;           ///< into its accelerations, as a multirotor does
};

/// The task: from when to when to move, and with which random numbers.
struct Task {
  double begin;  ///< of motion [s]
  double end;    ///< of motion [s]
  std::uint64_t seed;

  double window(double t, double ramp = 2.0) const { return smoothWindow(t, begin, end, ramp); }
};

/// Adds a multirotor's unrest: centimetres and degrees.
void addUnrest(const Sway& sway, double t, double metres, double radians, DesignedPose* pose) {
  pose->position_w += metres * sway.position(t);
  pose->yaw += radians * sway.at(3, t);
  pose->elevation += radians * sway.at(4, t);
  pose->roll += radians * sway.at(5, t);
}

/// Rides along a path and looks ahead, sweeping to both sides.
Design alongPath(const ClosedPath& path, const RideOptions& options, double sweep,
                 const Task& task) {
  const auto ride = std::make_shared<Ride>(path, options, task.begin, task.end, task.seed);
  const Sway sway(task.seed, "unrest", 0.2, 1.2), look(task.seed, "look", 0.05, 0.15);
  Design design;
  design.at = [=](double t) {
    DesignedPose pose;
    pose.position_w = ride->position(t);
    pose.yaw = ride->heading(t) + task.window(t) * sweep * look.at(3, t);
    pose.elevation = -4.0 * kDegree;
    addUnrest(sway, t, 0.006 * task.window(t), 1.2 * kDegree * task.window(t), &pose);
    return pose;
  };
  return design;
}

ClosedPath hallPath(std::uint64_t seed) {
  const Sway shape(seed, "hall path", 0.0, 0.0);  // constants of random size
  const double rise = 0.35 + 0.05 * shape.at(0, 0.0), turn = shape.at(1, 0.0);
  const ClosedPath flat = roundedRectangle(6.8, 2.35, 2.2, 1.6);
  return ClosedPath([=](double share) -> Vector3d {
    const double phi = 2.0 * M_PI * share;
    return flat.at(share * flat.length()) +
           Vector3d(0.0, 0.0, rise * (std::sin(2.0 * phi + turn) - std::sin(turn)));
  });
}

Design hallLoop(const Task& task) {
  return alongPath(hallPath(task.seed), {1.0, 0.3}, 10.0 * kDegree, task);
}

Design figureEight(const Task& task) {
  const ClosedPath path([](double share) -> Vector3d {
    const double phi = 2.0 * M_PI * share;
    return {6.8 * std::sin(phi), 2.3 * std::sin(2.0 * phi), 1.7 + 0.4 * std::sin(phi)};
  });
  return alongPath(path, {1.0, 0.3}, 8.0 * kDegree, task);
}

Design corridor(const Task& task) {
  return alongPath(roundedRectangle(8.75, 5.75, 1.2, 1.5), {1.1, 0.3, false}, 6.0 * kDegree, task);
}

Design hover(const Task& task) {
  const Sway slow(task.seed, "hover slow", 0.1, 0.5), quick(task.seed, "hover quick", 0.8, 2.5);
  Design design;
  design.at = [=](double t) {
    DesignedPose pose;
    pose.position_w = {0.0, 0.0, 1.5};
    addUnrest(slow, t, 0.02 * task.window(t), 1.5 * kDegree * task.window(t), &pose);
    addUnrest(quick, t, 0.002 * task.window(t), 0.3 * kDegree * task.window(t), &pose);
    return pose;
  };
  return design;
}

Design still(const Task&) {
  Design design;
  design.at = [](double) {
    DesignedPose pose;
    pose.position_w = {0.0, 0.0, 1.2};
    pose.yaw = 0.3;
    pose.elevation = -0.05;
    return pose;
  };
  return design;
}

/// Rounds in a room, without looking along the path: the camera sways about one direction.
Design roomRounds(const RideOptions& options, const Sway& look, double angle, const Task& task) {
  const ClosedPath path([](double share) -> Vector3d {
    const double phi = 2.0 * M_PI * share;
    return {1.95 * std::cos(phi), 1.25 * std::sin(phi), 1.5 + 0.3 * std::sin(2.0 * phi)};
  });
  const auto ride = std::make_shared<Ride>(path, options, task.begin, task.end, task.seed);
  Design design;
  design.at = [=](double t) {
    const double share = task.window(t);
    DesignedPose pose;
    pose.position_w = ride->position(t);
    pose.yaw = 2.0 * angle * share * look.at(3, t);
    pose.elevation = 0.5 * angle * share * look.at(4, t);
    pose.roll = 0.5 * angle * share * look.at(5, t);
    return pose;
  };
  return design;
}

Design fast(const Task& task) {
  const Sway look(task.seed, "fast look", 0.15, 0.45);
  Design design = roomRounds({1.75, 0.15}, look, 14.0 * kDegree, task);
  design.knot_interval = 0.05;
  return design;
}

Design pureRotation(const Task& task) {
  constexpr double kRotation = 15.0;
  const Task turning{task.begin, std::min(kRotation, task.end), task.seed};
  const Sway sway(task.seed, "turning", 0.1, 0.35);
  Design design;
  std::function<DesignedPose(double)> flight = still(task).at;
  if (task.end > kRotation + 1.0) {
    const Sway look(task.seed, "look", 0.1, 0.3);
    flight = roomRounds({0.7, 0.3}, look, 8.0 * kDegree, {kRotation, task.end, task.seed}).at;
  }
  design.at = [=](double t) {
    DesignedPose pose = flight(t);
    const double share = turning.window(t);
    pose.yaw += 35.0 * kDegree * share * sway.at(3, t);
    pose.elevation += 8.0 * kDegree * share * sway.at(4, t);
    pose.roll += 8.0 * kDegree * share * sway.at(5, t);
    return pose;
  };
  design.of_camera = true;
  // Position and rotation are smoothed apart; this finely, the camera stays within 0.1 mm.
  design.knot_interval = 0.025;
  return design;
}

Design staticThenMove(const Task& task) {
  constexpr double kStill = 4.0, kClimb = 3.0, kDepth = 1.2;
  const Task flying{kStill + 0.5 * kClimb, task.end, task.seed};
  if (task.end < kStill + kClimb) return still(task);
  const std::function<DesignedPose(double)> flight = hallLoop(flying).at;
  Design design;
  design.at = [=](double t) {
    DesignedPose pose = flight(t);
    // Later by the rest, for the smoothing reaches back that far.
    pose.position_w.z() -= kDepth * (1.0 - smoothStep(t - kStill - kRest, kClimb));
    return pose;
  };
  return design;
}

Design walk(const Task& task) {
  const auto walk = std::make_shared<Walk>(GaitOptions{}, task.begin, task.end, task.seed);
  Design design;
  design.at = [walk](double t) { return walk->at(t); };
  design.knot_interval = 0.0125;  // a hand trembles up to 13 Hz
  design.leans = false;
  return design;
}

struct Named {
  const char* name;
  const char* scene;
  Design (*design)(const Task& task);
};

constexpr Named kTrajectories[] = {
    {"hall_loop", "hall", hallLoop},
    {"figure_eight", "hall", figureEight},
    {"corridor", "corridor", corridor},
    {"hover", "room", hover},
    {"still", "room", still},
    {"pure_rotation", "room", pureRotation},
    {"static_then_move", "hall", staticThenMove},
    {"fast", "room", fast},
    {"walk", "household", walk},
};

const Named& find(const std::string& name) {
  std::string choices;
  for (const Named& trajectory : kTrajectories) {
    if (name == trajectory.name) return trajectory;
    choices += (choices.empty() ? "" : ", ") + std::string(trajectory.name);
  }
  throw InputError("trajectory: found '" + name + "'; allowed: " + choices);
}

/// The rotation that takes the vertical to the direction in which a multirotor's thrust has to
/// point.
Eigen::Quaterniond lean(const Design& design, double t) {
  constexpr double kStep = 0.1, kGravity = 9.81;
  const Vector3d before = design.at(t - kStep).position_w;
  const Vector3d now = design.at(t).position_w;
  const Vector3d after = design.at(t + kStep).position_w;
  const Vector3d acceleration = ((after - now) - (now - before)) / (kStep * kStep);
  if (acceleration.isZero(0.0)) return Eigen::Quaterniond::Identity();
  const Vector3d thrust = acceleration + kGravity * Vector3d::UnitZ();
  return Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), thrust);
}

/// T_wb of a designed pose.
Pose bodyPose(const Design& design, double t, const Pose& T_bc) {
  const DesignedPose designed = design.at(t);
  const Eigen::Quaterniond R_lean = design.leans ? lean(design, t) : Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond R_wc = R_lean * designed.cameraRotation();
  const Eigen::Quaterniond R_wb = (R_wc * T_bc.rotation.conjugate()).normalized();
  const Vector3d lever = design.of_camera ? R_wb * T_bc.position : Vector3d::Zero();
  return {R_wb, designed.position_w - lever};
}

}  // namespace

std::vector<std::string> builtinTrajectoryNames() {
  std::vector<std::string> names;
  for (const Named& trajectory : kTrajectories) names.emplace_back(trajectory.name);
  return names;
}

std::string sceneOfBuiltinTrajectory(const std::string& name) { return find(name).scene; }

TrajectorySpline makeBuiltinTrajectory(const std::string& name, std::uint64_t seed, double duration,
                                       const Pose& T_bc, Stamp epoch) {
  const Named& trajectory = find(name);
  if (!(duration >= 1.0 && duration <= 36000.0)) {
    std::ostringstream message;
    message << "trajectory " << name << ": duration is " << duration << "; allowed: 1 to 36000 s";
    throw InputError(message.str());
  }
  const Design design = trajectory.design({kRest, duration - kRest, seed});
  const double interval = design.knot_interval;
  const auto segments = static_cast<int>(std::ceil((duration + 2.0 * kMargin) / interval));
  std::vector<Pose> controls;
  for (int j = 0; j < segments + kSplineOrder - 1; ++j) {
    controls.push_back(bodyPose(design, -kMargin + (j - 2) * interval, T_bc));
  }
  return {epoch, -kMargin, interval, controls};
}

}  // namespace vins::simulation
