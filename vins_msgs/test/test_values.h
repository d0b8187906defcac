#pragma once

#include <cstdint>
#include <limits>
#include <random>
#include <string>

#include "vins_msgs/conversions.h"

namespace vins_msgs {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A stamp of EuRoC's MH_01_easy, which a double in seconds cannot hold to the nanosecond.
constexpr vins::Stamp kStamp = 1403636580838555648;
constexpr vins::Stamp kLastStamp = 4294967295'999999999;

/// Makes values of every type that has a message: random, valid, and no field with the value that
/// its type starts with, so that one which a conversion forgets is seen.
class Random {
 public:
  double number() { return normal_(generator_); }
  std::int64_t id() { return static_cast<std::int64_t>(generator_()); }
  std::uint32_t sequence() { return static_cast<std::uint32_t>(generator_()); }
  int count() { return 2 + static_cast<int>(generator_() % 2147483646U); }
  vins::Stamp stamp() { return static_cast<vins::Stamp>(generator_() % kLastStamp); }
  Eigen::Vector3d vector() { return {number(), number(), number()}; }
  Eigen::Vector3d bearing() { return vector().normalized(); }
  Eigen::Vector2d pixel() { return 100.0 * Eigen::Vector2d(number(), number()); }
  std::string text() { return "text \n\" " + std::to_string(generator_()); }

  /// Not symmetric, so that rows and columns cannot be taken for each other.
  template <int n>
  Eigen::Matrix<double, n, n> matrix() {
    return Eigen::Matrix<double, n, n>::NullaryExpr([this]() { return number(); });
  }

  vins::Pose pose() {
    const Eigen::Quaterniond q(number(), number(), number(), number());
    return {q.normalized(), vector()};
  }

  vins::ImuSample imuSample() { return {stamp(), vector(), vector()}; }
  vins::ImuBiasEstimate imuBias() {
    return {stamp(), vector(), vector(), matrix<3>(), matrix<3>()};
  }
  vins::FeatureObservation observation() {
    return {id(), 1, count(), pixel(), bearing(), vector(), std::abs(number())};
  }
  vins::FeatureFrame featureFrame() {
    return {stamp(), sequence(), {observation(), observation(), observation()}};
  }
  vins::KeyframePoint keyframePoint() { return {id(), pixel(), bearing(), vector()}; }
  vins::Keyframe keyframe() {
    return {id(),
            sequence(),
            stamp(),
            stamp(),
            pose(),
            pose(),
            matrix<6>(),
            {keyframePoint(), keyframePoint(), keyframePoint()},
            sequence()};
  }
  vins::KeyframePoseUpdate poseUpdate() { return {id(), sequence(), stamp(), pose()}; }
  vins::MatchedFeature matchedFeature() { return {id(), bearing()}; }
  vins::LoopMatch loopMatch() {
    return {id(),
            id(),
            stamp(),
            pose(),
            pose(),
            pose(),
            {matchedFeature(), matchedFeature(), matchedFeature()}};
  }
  vins::LoopEdge loopEdge() { return {id(), id(), stamp(), pose(), matrix<6>(), count()}; }
  vins::Event event() {
    return {stamp(),
            vins::Severity::kError,
            text(),
            text(),
            {{text(), number()}, {text(), number()}, {text(), number()}}};
  }

 private:
  std::mt19937_64 generator_{5};
  std::normal_distribution<double> normal_;
};

/// The text of the exception that f throws, or "accepted".
template <typename F>
std::string refusal(const F& f) {
  try {
    f();
  } catch (const vins::InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace vins_msgs
