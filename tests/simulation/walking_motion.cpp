#include "simulation/walking_motion.h"

#include <algorithm>
#include <cmath>

namespace vins::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRamp = 0.7;           ///< in which a leg reaches its full speed [s]
constexpr double kSettle = 2.0;         ///< in which the motion begins and ends [s]
constexpr double kShortestLeg = 0.7;    ///< [m]
constexpr double kSidestepShare = 0.5;  ///< of the legs
constexpr double kDegree = M_PI / 180.0;

/// Integral of smoothStep(t, ramp): the way of a speed that rises to 1.
double rampWay(double t, double ramp) {
  if (t <= 0.0) return 0.0;
  if (t >= ramp) return t - 0.5 * ramp;
  const double x = t / ramp;
  return ramp * x * x * x * x * (2.5 + x * (x - 3.0));
}

/// Share of the way done at t of a leg that rises to full speed and falls to rest.
double legShare(double t, double duration) {
  const double ramp = std::min(kRamp, 0.5 * duration);
  return (rampWay(t, ramp) - rampWay(t - duration + ramp, ramp)) / (duration - ramp);
}

double durationOfLeg(double length, double speed) { return length / speed + kRamp; }

Vector2d anyPlace(Random* random, double half_side) {
  const double x = random->uniform(-half_side, half_side);
  return {x, random->uniform(-half_side, half_side)};
}

Vector2d placeAwayFrom(const Vector2d& from, Random* random, double half_side) {
  Vector2d place = anyPlace(random, half_side);
  for (int i = 0; i < 20 && (place - from).norm() < kShortestLeg; ++i) {
    place = anyPlace(random, half_side);
  }
  return place;
}

}  // namespace

Walk::Phase Walk::lookingAcross(const Phase& a, const Phase& b) {
  const Vector2d to_middle = -0.5 * (a.from + a.to);
  const auto across = [&](const Phase& leg) {
    return to_middle.dot(Vector2d(std::cos(leg.yaw_from), std::sin(leg.yaw_from)));
  };
  return across(a) > across(b) ? a : b;
}

Walk::Walk(const GaitOptions& options, double begin, double end, std::uint64_t seed)
    : options_(options),
      begin_(begin),
      end_(end),
      pace_(seed, "walk pace", 0.05, 0.2),
      arm_(seed, "walk arm", 0.1, 0.6),
      look_(seed, "walk look", 0.06, 0.25),
      quick_(seed, "walk tremor quick", 8.0, 13.0),
      slow_(seed, "walk tremor slow", 4.0, 8.0) {
  Random random(seed, "walk");
  step_phase_ = random.uniform(0.0, 2.0 * M_PI);
  Phase last;
  last.begin = last.end = begin;
  last.to = anyPlace(&random, options.half_side);
  last.yaw_to = random.uniform(0.0, 2.0 * M_PI);
  while (last.end < end) {
    const Phase leg = nextLeg(last, &random);
    phases_.push_back(turnTowards(leg.yaw_from, last, &random));
    last = startedAfter(phases_.back(), leg, &random);
    phases_.push_back(last);
  }
}

Walk::Phase Walk::nextLeg(const Phase& last, Random* random) const {
  const Vector2d place = placeAwayFrom(last.to, random, options_.half_side);
  const Vector2d way = place - last.to;
  // A person films across the direction of travel as often as along it.
  const double look = random->uniform(-75.0, 75.0), other = random->uniform(-75.0, 75.0);
  Phase leg;
  leg.from = last.to;
  leg.to = place;
  leg.yaw_from = std::atan2(way.y(), way.x()) + look * kDegree;
  Phase alternative = leg;
  alternative.yaw_from += (other - look) * kDegree;
  // Or steps aside or back without turning.
  if (random->uniform() < kSidestepShare) leg.yaw_from = alternative.yaw_from = last.yaw_to;
  return lookingAcross(leg, alternative);
}

Walk::Phase Walk::turnTowards(double yaw, const Phase& last, Random* random) const {
  const double turn = std::remainder(yaw - last.yaw_to, 2.0 * M_PI);
  // The peak of a smooth step's speed is 15 / 8 of its mean.
  const double turning = 15.0 / 8.0 * std::abs(turn) / options_.max_turn_rate;
  Phase phase;
  phase.begin = last.end;
  phase.end = phase.begin + std::max(turning, random->uniform(0.2, 1.5));
  phase.from = phase.to = last.to;
  phase.yaw_from = last.yaw_to;
  phase.yaw_to = last.yaw_to + turn;
  return phase;
}

Walk::Phase Walk::startedAfter(const Phase& turn, const Phase& leg, Random* random) const {
  Phase started = leg;
  started.begin = turn.end;
  started.end = turn.end + durationOfLeg((leg.to - leg.from).norm(), options_.walking_speed);
  started.yaw_from = turn.yaw_to;
  started.yaw_to = turn.yaw_to + random->uniform(-35.0, 35.0) * kDegree;
  return started;
}

const Walk::Phase& Walk::phaseAt(double t) const {
  const auto next = std::upper_bound(phases_.begin(), phases_.end(), t,
                                     [](double time, const Phase& p) { return time < p.begin; });
  return next == phases_.begin() ? phases_.front() : *(next - 1);
}

double Walk::walkingTime(double t) const {
  const double settle = std::min(kSettle, end_ - begin_);
  const double settling = std::clamp(t, begin_, end_) - (end_ - settle);
  if (settling <= 0.0) return std::max(t, begin_);
  return end_ - settle + settling - rampWay(settling, settle);
}

double Walk::activity(double t) const {
  const double walked = walkingTime(t);
  const Phase& phase = phaseAt(walked);
  if (phase.from == phase.to) return 0.0;
  return smoothWindow(walked, phase.begin, phase.end, kRamp) *
         smoothWindow(t, begin_, end_, kSettle);
}

void Walk::addGait(double t, const Phase& phase, DesignedPose* pose) const {
  const double active = activity(t);
  if (active <= 0.0) return;
  const double step = options_.walking_speed / options_.step_frequency;
  const double leg = options_.leg_length;
  const double bob = options_.arm_share * 0.5 * (leg - std::sqrt(leg * leg - 0.25 * step * step));
  // Half a period of the pace's variation shifts the phase by a few percent of a step.
  const double angle =
      2.0 * M_PI * options_.step_frequency * t + step_phase_ + 0.6 * pace_.at(0, t);
  const Vector2d ahead = (phase.to - phase.from).normalized();
  const Vector3d forward(ahead.x(), ahead.y(), 0.0), left(-ahead.y(), ahead.x(), 0.0);
  // The second harmonic is the heel's strike.
  const double up = bob * std::cos(angle) + 0.12 * bob * std::cos(2.0 * angle + 0.8);
  pose->position_w += active * up * Vector3d::UnitZ();
  pose->position_w += active * options_.lateral_sway * std::sin(0.5 * angle) * left;
  pose->position_w += active * 0.5 * bob * std::sin(angle) * forward;
  pose->elevation += active * 0.35 * kDegree * std::cos(angle + 0.5);
  pose->roll += active * 0.9 * kDegree * std::sin(0.5 * angle + 0.3);
  pose->yaw += active * 0.9 * kDegree * std::cos(0.5 * angle);
}

void Walk::addHand(double t, DesignedPose* pose) const {
  const double share = smoothWindow(t, begin_, end_, kSettle);
  const double slow = 2.0 * M_PI * 6.0, quick = 2.0 * M_PI * 10.5;
  const double half = std::sqrt(0.5);  // half of the variance in each band
  const double acceleration = half * options_.tremor_acceleration;
  const double rate = half * options_.tremor_rate;
  pose->position_w += share * 0.018 * arm_.position(t);
  pose->position_w += share * acceleration / (slow * slow) * slow_.position(t);
  pose->position_w += share * acceleration / (quick * quick) * quick_.position(t);
  const auto angle = [&](int channel) {
    return share * (1.2 * kDegree * arm_.at(channel, t) + rate / slow * slow_.at(channel, t) +
                    rate / quick * quick_.at(channel, t));
  };
  pose->yaw += angle(3) + share * 7.0 * kDegree * look_.at(3, t);
  pose->elevation += angle(4) + share * 2.0 * kDegree * look_.at(4, t);
  pose->roll += angle(5) + share * 1.5 * kDegree * look_.at(5, t);
}

DesignedPose Walk::at(double t) const {
  const double walked = walkingTime(t);
  const Phase& phase = phaseAt(walked);
  const double duration = phase.end - phase.begin;
  const double share = legShare(walked - phase.begin, duration);
  const Vector2d place = phase.from + share * (phase.to - phase.from);
  DesignedPose pose;
  pose.position_w = {place.x(), place.y(), options_.hand_height};
  pose.yaw =
      phase.yaw_from + smoothStep(walked - phase.begin, duration) * (phase.yaw_to - phase.yaw_from);
  pose.elevation = options_.elevation;
  addGait(t, phase, &pose);
  addHand(t, &pose);
  return pose;
}

}  // namespace vins::simulation
