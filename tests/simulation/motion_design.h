#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "simulation/closed_path.h"
#include "vins_core/pose.h"

namespace vins::simulation {

/// What a built-in trajectory is drawn with: where the body is and where the camera looks.
struct DesignedPose {
  Eigen::Vector3d position_w = Eigen::Vector3d::Zero();  ///< of the body [m]
  double yaw = 0.0;        ///< of the optical axis about z, from x [rad]
  double elevation = 0.0;  ///< of the optical axis above the horizon [rad]
  double roll = 0.0;       ///< about the optical axis [rad]

  /// R_wc with the camera's x to the right, y down, z ahead.
  Eigen::Quaterniond cameraRotation() const;
};

/// 0 up to t = 0, 1 from t = duration on, smooth (C2) between: 6 x^5 - 15 x^4 + 10 x^3.
double smoothStep(double t, double duration);

/// 1 within (begin, end), falling smoothly to 0 at both within `ramp` [s].
double smoothWindow(double t, double begin, double end, double ramp);

/// Slow, irregular swaying: a sum of four sinusoids with random phases, per channel.
class Sway {
 public:
  /// Frequencies [Hz] are spread over the range; `stream` names the random numbers.
  Sway(std::uint64_t seed, const std::string& stream, double min_frequency, double max_frequency);

  /// Root mean square 1, mean 0. Channels 0 to 5 are independent.
  double at(int channel, double t) const;
  Eigen::Vector3d position(double t) const { return {at(0, t), at(1, t), at(2, t)}; }

 private:
  struct Sinusoid {
    double frequency, phase;
  };
  std::array<std::array<Sinusoid, 4>, 6> channels_;
};

/// How fast to ride, and how to make the rounds whole. Where there is no time for about half a
/// round, neither path nor speed is changed, and the ride ends on the way.
struct RideOptions {
  double speed = 1.0;      ///< mean, but for the ramps [m/s]
  double variation = 0.3;  ///< share of the speed by which it usually varies, up and down
  bool shrinks = true;     ///< the path is shrunk; else the speed is changed
};

/// A ride along a closed path, a whole number of rounds between two times [s]. It starts and ends
/// at rest, with ramps of 2 s.
class Ride {
 public:
  Ride(const ClosedPath& path, const RideOptions& options, double begin, double end,
       std::uint64_t seed);

  Eigen::Vector3d position(double t) const;
  /// Yaw of the direction of travel a little ahead, without jumps [rad].
  double heading(double t) const;

 private:
  double travelled(double t) const;

  double begin_;
  std::vector<double> travelled_;  ///< at begin_ + i kStep [m]
  ClosedPath path_;
  std::vector<double> headings_;  ///< at i times round / kHeadings, of the first round [rad]
};

}  // namespace vins::simulation
