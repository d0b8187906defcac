#include "simulation/motion_design.h"

#include <algorithm>
#include <cmath>

#include "simulation/random.h"

namespace vins::simulation {
namespace {

constexpr double kStep = 0.01;      ///< of a ride's table [s]
constexpr double kRamp = 2.0;       ///< of a ride's speed [s]
constexpr int kHeadings = 720;      ///< of a ride's table of headings
constexpr double kLookAhead = 0.4;  ///< the heading is that of a chord this long [m]

/// How far a ride goes, at every kStep.
std::vector<double> integrateSpeed(const RideOptions& options, double begin, double end,
                                   std::uint64_t seed) {
  const Sway sway(seed, "ride speed", 0.05, 0.25);
  std::vector<double> travelled = {0.0};
  for (double t = begin + 0.5 * kStep; t < end; t += kStep) {
    const double share = std::clamp(options.variation * sway.at(0, t), -0.6, 0.6);
    const double now = options.speed * (1.0 + share) * smoothWindow(t, begin, end, kRamp);
    travelled.push_back(travelled.back() + kStep * now);
  }
  return travelled;
}

ClosedPath shrunkToWholeRounds(const ClosedPath& path, double travelled) {
  if (travelled < 0.5 * path.length()) return path;
  const double rounds = std::ceil(travelled / path.length());
  return path.scaledBy(travelled / (rounds * path.length()));
}

std::vector<double> chordHeadings(const ClosedPath& path) {
  const double chord = std::min(kLookAhead, 0.05 * path.length());
  std::vector<double> headings;
  for (int i = 0; i <= kHeadings; ++i) {
    const double along = path.length() * i / kHeadings;
    const Eigen::Vector3d ahead = path.at(along + chord) - path.at(along);
    const double heading = std::atan2(ahead.y(), ahead.x());
    const double before = headings.empty() ? heading : headings.back();
    headings.push_back(before + std::remainder(heading - before, 2.0 * M_PI));
  }
  return headings;
}

}  // namespace

Eigen::Quaterniond DesignedPose::cameraRotation() const {
  Eigen::Matrix3d R_level;
  R_level << 0, 0, 1,  //
      -1, 0, 0,        //
      0, -1, 0;
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(-elevation, Eigen::Vector3d::UnitY()) * Eigen::Quaterniond(R_level) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ());
}

double smoothStep(double t, double duration) {
  const double x = std::clamp(t / duration, 0.0, 1.0);
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

double smoothWindow(double t, double begin, double end, double ramp) {
  const double rise = std::min(ramp, 0.5 * (end - begin));
  return smoothStep(t - begin, rise) * smoothStep(end - t, rise);
}

Sway::Sway(std::uint64_t seed, const std::string& stream, double min_frequency,
           double max_frequency) {
  Random random(seed, stream);
  for (auto& channel : channels_) {
    for (Sinusoid& sinusoid : channel) {
      sinusoid.frequency = random.uniform(min_frequency, max_frequency);
      sinusoid.phase = random.uniform(0.0, 2.0 * M_PI);
    }
  }
}

double Sway::at(int channel, double t) const {
  double sum = 0.0;
  for (const Sinusoid& s : channels_[static_cast<std::size_t>(channel)]) {
    sum += std::sin(2.0 * M_PI * s.frequency * t + s.phase);
  }
  return std::sqrt(0.5) * sum;
}

Ride::Ride(const ClosedPath& path, const RideOptions& options, double begin, double end,
           std::uint64_t seed)
    : begin_(begin),
      travelled_(integrateSpeed(options, begin, end, seed)),
      path_(options.shrinks ? shrunkToWholeRounds(path, travelled_.back()) : path),
      headings_(chordHeadings(path_)) {
  const double rounds = travelled_.back() / path_.length();
  if (rounds < 0.75) return;
  const double factor = std::max(1.0, std::round(rounds)) / rounds;
  for (double& length : travelled_) length *= factor;
}

double Ride::travelled(double t) const {
  const double place =
      std::clamp((t - begin_) / kStep, 0.0, static_cast<double>(travelled_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(place), travelled_.size() - 2);
  const double share = place - static_cast<double>(i);
  return travelled_[i] + share * (travelled_[i + 1] - travelled_[i]);
}

Eigen::Vector3d Ride::position(double t) const { return path_.at(travelled(t)); }

double Ride::heading(double t) const {
  const double rounds = travelled(t) / path_.length();
  const double whole = std::floor(rounds);
  const double place = (rounds - whole) * kHeadings;
  const auto i = std::min(static_cast<std::size_t>(place), headings_.size() - 2);
  const double share = place - static_cast<double>(i);
  return whole * (headings_.back() - headings_.front()) + headings_[i] +
         share * (headings_[i + 1] - headings_[i]);
}

}  // namespace vins::simulation
