#include "vins_estimator/initialization/initializer.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "vins_core/option_check.h"
#include "vins_core/time.h"

namespace vins::estimator {
namespace {

constexpr double kShorterSpan = 0.7;  ///< of the next shorter span that is tried
constexpr int kSpansTried = 3;        ///< in one attempt
constexpr double kJitter = 0.01;      ///< of camera periods [s]

InitializerOptions checked(InitializerOptions options) {
  options.stillness.gravity = options.imu.gravity;
  options.validate();
  return options;
}

}  // namespace

void InitializerOptions::validate() const {
  imu.validate();
  const std::pair<const char*, double> positive[] = {{"pixel_noise", pixel_noise},
                                                     {"max_span", max_span},
                                                     {"min_span", min_span},
                                                     {"attempt_interval", attempt_interval},
                                                     {"report_interval", report_interval},
                                                     {"max_gap", max_gap}};
  for (const auto& [name, value] : positive) {
    requirePositive("initialization", name, value);
  }
  if (max_frames < 5) refuseOption("initialization", "max_frames", max_frames, "at least 5");
  if (min_span > max_span) refuseOption("initialization", "min_span", min_span, "at most max_span");
  stillness.validate();
  at_rest.validate();
  structure.validate();
  alignment.validate();
}

Initializer::Initializer(const InitializerOptions& options)
    : options_(checked(options)),
      stillness_(options_.stillness),
      frames_until_attempt_(options_.attempt_interval),
      engine_(options_.seed) {}

void Initializer::clear() {
  stillness_.clear();
  buffer_.clear();
  frames_until_attempt_ = options_.attempt_interval;
  reason_ = WaitingReason();
  last_report_.reset();
  engine_.seed(options_.seed);
}

std::vector<Event> Initializer::takeEvents() {
  std::vector<Event> events;
  events.swap(events_);
  return events;
}

double Initializer::bufferedSpan() const {
  return toSeconds(buffer_.back()->frame.stamp - buffer_.front()->frame.stamp);
}

void Initializer::forgetOld() {
  const double longest = std::max(options_.max_span, options_.stillness.window) + kJitter;
  while (bufferedSpan() > longest) buffer_.pop_front();
}

void Initializer::push(const SharedMeasurements& measurements) {
  const bool follows = !measurements->is_first && !measurements->restarted &&
                       measurements->longest_gap <= options_.max_gap;
  if (!follows) clear();
  buffer_.push_back(measurements);
  forgetOld();
}

void Initializer::remember(const SharedMeasurements& measurements) { push(measurements); }

std::optional<Initialization> Initializer::solveAgain() {
  if (buffer_.empty() || bufferedSpan() + kJitter < options_.min_span) return std::nullopt;
  return startMoving();
}

RetimedFrames Initializer::retime(const SharedMeasurements& newest, double shift) {
  push(newest);
  RetimedFrames retimed = estimator::retime(buffer_, shift);
  buffer_.assign(retimed.frames.begin(), retimed.frames.end());
  stillness_.clear();
  frames_until_attempt_ = 0;
  return retimed;
}

std::optional<Initialization> Initializer::addFrame(const SharedMeasurements& measurements,
                                                    bool may_move) {
  push(measurements);
  stillness_.addFrame(measurements);

  std::optional<Initialization> found;
  --frames_until_attempt_;
  if (stillness_.isStill()) {
    found = startAtRest();
  } else if (may_move && frames_until_attempt_ <= 0 &&
             bufferedSpan() + kJitter >= options_.min_span) {
    frames_until_attempt_ = options_.attempt_interval;
    found = startMoving();
  }
  if (found && found->at_rest) {
    clear();
  } else if (!found) {
    report(measurements->frame.stamp);
  }
  return found;
}

std::optional<Initialization> Initializer::startAtRest() const {
  const Stamp oldest =
      buffer_.back()->frame.stamp - toNanoseconds(options_.stillness.window + kJitter);
  std::vector<const FrameMeasurements*> interval;
  for (const SharedMeasurements& measurements : buffer_) {
    if (measurements->frame.stamp >= oldest) interval.push_back(measurements.get());
  }
  return initializeAtRest(interval, options_.imu, options_.at_rest);
}

std::optional<Initialization> Initializer::startMoving() {
  const InputFigures inputs = figuresOf(buffer_);
  reason_ = explainFewTracks(inputs);
  for (const FrameIndices& chosen : chooseFrames()) {
    const std::vector<Preintegration> imu = integrateBetween(chosen);
    const VisualStructure structure = buildStructure(
        structureFrames(chosen, imu), options_.pixel_noise, options_.structure, engine_());
    if (structure.ok()) return alignFrames(chosen, structure, imu, inputs);
    reason_ = explain(structure, inputs);
    // Over a shorter span more features stay in view, but there is less parallax.
    if (structure.status == StructureStatus::kLittleParallax) break;
  }
  return std::nullopt;
}

/// Sets of frames to try, the longest span first.
std::vector<Initializer::FrameIndices> Initializer::chooseFrames() const {
  std::vector<FrameIndices> choices;
  double span = std::min(bufferedSpan(), options_.max_span);
  for (; span + kJitter >= options_.min_span; span *= kShorterSpan) {
    FrameIndices chosen = spreadOver(span);
    if (static_cast<int>(chosen.size()) < 5 || !isConnected(chosen)) continue;
    choices.push_back(std::move(chosen));
    if (static_cast<int>(choices.size()) == kSpansTried) break;
  }
  return choices;
}

/// Indices of frames evenly spread over the last `span` seconds, the newest among them.
Initializer::FrameIndices Initializer::spreadOver(double span) const {
  const Stamp oldest = buffer_.back()->frame.stamp - toNanoseconds(span + kJitter);
  std::size_t first = 0;
  while (buffer_[first]->frame.stamp < oldest) ++first;
  const std::size_t available = buffer_.size() - first;
  const std::size_t count = std::min(available, static_cast<std::size_t>(options_.max_frames));
  FrameIndices chosen;
  for (std::size_t i = 0; i < count; ++i) {
    chosen.push_back(count == 1 ? first : first + i * (available - 1) / (count - 1));
  }
  return chosen;
}

int Initializer::sharedFeatures(std::size_t a, std::size_t b) const {
  std::unordered_set<std::int64_t> ids;
  for (const FeatureObservation& observation : buffer_[a]->frame.observations) {
    if (observation.camera == 0) ids.insert(observation.id);
  }
  int shared = 0;
  for (const FeatureObservation& observation : buffer_[b]->frame.observations) {
    if (observation.camera == 0 && ids.count(observation.id) > 0) ++shared;
  }
  return shared;
}

bool Initializer::isConnected(const FrameIndices& chosen) const {
  for (std::size_t i = 1; i < chosen.size(); ++i) {
    if (sharedFeatures(chosen[i - 1], chosen[i]) <= options_.structure.min_shared) return false;
  }
  return true;
}

std::vector<Preintegration> Initializer::integrateBetween(const FrameIndices& chosen) const {
  const Preintegration nothing(options_.imu, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  std::vector<Preintegration> imu(chosen.size(), nothing);
  for (std::size_t i = 1; i < chosen.size(); ++i) {
    for (std::size_t k = chosen[i - 1] + 1; k <= chosen[i]; ++k) {
      imu[i].integrate(buffer_[k]->imu);
    }
  }
  return imu;
}

std::vector<StructureFrame> Initializer::structureFrames(
    const FrameIndices& chosen, const std::vector<Preintegration>& imu) const {
  std::vector<StructureFrame> frames;
  const Eigen::Quaterniond& R_bc = options_.T_bc.rotation;
  Eigen::Quaterniond R_b0_b = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    R_b0_b = (R_b0_b * imu[i].gamma()).normalized();
    frames.push_back({&buffer_[chosen[i]]->frame, R_bc.conjugate() * R_b0_b * R_bc});
  }
  return frames;
}

std::optional<Initialization> Initializer::alignFrames(const FrameIndices& chosen,
                                                       const VisualStructure& structure,
                                                       const std::vector<Preintegration>& imu,
                                                       const InputFigures& inputs) {
  const Alignment alignment = align(structure, imu, options_.T_bc, options_.alignment);
  if (alignment.ok()) return toInitialization(chosen, alignment);
  reason_ = explain(alignment, inputs);
  return std::nullopt;
}

Initialization Initializer::toInitialization(const FrameIndices& chosen,
                                             const Alignment& alignment) const {
  Initialization initialization;
  initialization.scale_sigma = alignment.scale_sigma;
  const JointRefinementOptions& joint = options_.alignment.joint;
  constexpr double kUnknownTilt = 1.0;       // [rad]
  constexpr double kUnknownVelocity = 10.0;  // [m/s]
  initialization.mean = alignment.solution.states.front();
  initialization.mean.accelerometer_bias.setZero();
  initialization.mean.gyroscope_bias.setZero();
  initialization.sigma.segment<3>(kPosition).setConstant(joint.position_sigma);
  initialization.sigma.segment<3>(kRotation) << kUnknownTilt, kUnknownTilt, joint.yaw_sigma;
  initialization.sigma.segment<3>(kVelocity).setConstant(kUnknownVelocity);
  initialization.sigma.segment<3>(kAccBias).setConstant(joint.accelerometer_bias_sigma);
  initialization.sigma.segment<3>(kGyrBias).setConstant(joint.gyroscope_bias_sigma);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    initialization.frames.push_back(
        {buffer_[chosen[i]]->frame, alignment.solution.states[i], alignment.solution.imu[i],
         buffer_[chosen[i]]->imu.back().angular_velocity,
         angularAcceleration(buffer_[chosen[i]]->imu), buffer_[chosen[i]]->undone_readout});
  }
  return initialization;
}

void Initializer::report(Stamp stamp) {
  // The first words come after an interval of waiting, not with the first frame.
  if (!last_report_) last_report_ = stamp;
  if (reason_.code == nullptr) return;
  if (toSeconds(stamp - *last_report_) + kJitter < options_.report_interval) return;
  last_report_ = stamp;
  events_.push_back({stamp, Severity::kInfo, reason_.code, reason_.text, reason_.figures});
  reason_ = WaitingReason();
}

}  // namespace vins::estimator
