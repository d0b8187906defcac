#include "vins_estimator/inertial/measurement_queue.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "vins_core/option_check.h"

namespace vins::estimator {
namespace {

constexpr std::size_t kPeriods = 50;      ///< measured before their median is taken
constexpr std::size_t kFirstPeriods = 5;  ///< the same for the first time

bool isBefore(const ImuSample& sample, Stamp stamp) { return sample.stamp < stamp; }

}  // namespace

void MeasurementQueueOptions::validate() const {
  requireWithin("measurement queue", "max_frames", max_frames, {0, 1e6});
  requireWithin("measurement queue", "imu_rate", imu_rate, {1.0, 1e5});
  requireWithin("measurement queue", "gap_periods", gap_periods, {1.1, 1e3});
  requireWithin("measurement queue", "lead_in", lead_in, {0.0, 60.0});
  requireWithin("measurement queue", "max_jump", max_jump, {0.01, 1e6});
  requireWithin("measurement queue", "max_lead", max_lead, {0.1, 1e6});
  requireWithin("measurement queue", "event_interval", event_interval, {0.0, 1e6});
}

Eigen::Vector3d angularAcceleration(const std::vector<ImuSample>& samples) {
  constexpr double kSpan = 0.02;  // [s]
  if (samples.size() < 2) return Eigen::Vector3d::Zero();
  const ImuSample& last = samples.back();
  std::size_t first = samples.size() - 2;
  while (first > 0 && toSeconds(last.stamp - samples[first].stamp) < kSpan) --first;
  const double span = toSeconds(last.stamp - samples[first].stamp);
  return (last.angular_velocity - samples[first].angular_velocity) / std::max(span, 1e-4);
}

MeasurementQueue::MeasurementQueue(const MeasurementQueueOptions& options)
    : options_(options), period_(1.0 / options.imu_rate) {
  options_.validate();
}

void MeasurementQueue::addImu(const ImuSample& sample) {
  if (acceptImu(sample)) {
    imu_.push_back(sample);
    // Without frames nothing else would forget samples.
    constexpr double kLongest = 60.0;  // [s]
    while (toSeconds(sample.stamp - imu_.front().stamp) > kLongest) imu_.pop_front();
    newest_imu_ = sample.stamp;
    // Until a first frame has come, only what may lead to one is worth keeping.
    if (frames_.empty() && !end_) forgetUntil(sample.stamp - 2 * toNanoseconds(options_.lead_in));
  }
  tellDisorder(std::max(sample.stamp, newest_imu_.value_or(sample.stamp)));
}

bool MeasurementQueue::acceptImu(const ImuSample& sample) {
  if (!sample.isFinite()) {
    ++disorder_.not_finite;
    return false;
  }
  if (!newest_imu_) return true;
  const double step = toSeconds(sample.stamp - *newest_imu_);
  if (step < -options_.max_jump) {
    jumpBack(*newest_imu_, sample.stamp);
    return true;
  }
  if (step <= 0.0) {
    ++(step == 0.0 ? disorder_.duplicates : disorder_.out_of_order);
    return false;
  }
  if (step > options_.gap_periods * period_) {
    std::ostringstream text;
    text << "no IMU samples for " << step << " s";
    tell(sample.stamp, Severity::kWarning, "imu_gap", text.str(),
         {{"gap_s", step}, {"period_s", period_}});
  }
  measurePeriod(step);
  return true;
}

void MeasurementQueue::measurePeriod(double period) {
  periods_.push_back(period);
  if (periods_.size() < (period_measured_ ? kPeriods : kFirstPeriods)) return;
  const auto middle = periods_.begin() + static_cast<std::ptrdiff_t>(periods_.size() / 2);
  std::nth_element(periods_.begin(), middle, periods_.end());
  period_ = *middle;
  period_measured_ = true;
  periods_.clear();
}

void MeasurementQueue::jumpBack(Stamp from, Stamp to) {
  // The other stream may have jumped before, or is still to jump: what it has of the new time
  // stays.
  const Stamp latest = to + toNanoseconds(options_.max_jump);
  if (newest_imu_ && *newest_imu_ > latest) {
    imu_.clear();
    newest_imu_.reset();
  }
  const auto is_old = [&](const FeatureFrame& frame) { return frame.stamp > latest; };
  frames_.erase(std::remove_if(frames_.begin(), frames_.end(), is_old), frames_.end());
  if (newest_frame_ && *newest_frame_ > latest) {
    newest_frame_.reset();
    if (!frames_.empty()) newest_frame_ = frames_.back().stamp;
  }
  end_.reset();
  if (restarted_) return;
  restarted_ = true;
  std::ostringstream text;
  text << "stamps have jumped back by " << toSeconds(from - to)
       << " s, as when a recording is played again: starting anew";
  tell(to, Severity::kWarning, "time_jump", text.str(), {{"jump_s", toSeconds(to - from)}});
}

void MeasurementQueue::addFrame(FeatureFrame frame) {
  if (newest_frame_) {
    const double step = toSeconds(frame.stamp - *newest_frame_);
    if (step < -options_.max_jump) {
      jumpBack(*newest_frame_, frame.stamp);
    } else if (step <= 0.0) {
      ++dropped_.out_of_order;
      tellDropped(*newest_frame_);
      return;
    }
  }
  if (isFarAhead(frame.stamp)) {
    ++dropped_.ahead;
    tellDropped(*newest_imu_);
    return;
  }
  const Stamp stamp = frame.stamp;
  newest_frame_ = stamp;
  frames_.push_back(std::move(frame));
  if (options_.max_frames > 0 && frames_.size() > static_cast<std::size_t>(options_.max_frames)) {
    frames_.pop_front();
    ++dropped_.overflown;
  }
  tellDropped(stamp);
}

bool MeasurementQueue::isFarAhead(Stamp stamp) const {
  if (!newest_imu_) return false;
  const Stamp newest = std::max(*newest_imu_, newest_frame_.value_or(*newest_imu_));
  return toSeconds(stamp - newest) > options_.max_lead;
}

std::optional<FrameMeasurements> MeasurementQueue::next(double td, double readout) {
  const Stamp offset = toNanoseconds(td);
  while (!frames_.empty() && !imu_.empty()) {
    const Stamp end = frames_.front().stamp + offset;
    if (end + toNanoseconds(readout) > imu_.back().stamp) return std::nullopt;
    const bool is_covered = end >= imu_.front().stamp && (!end_ || end > *end_);
    if (is_covered) return cutOut(end, readout);
    dropEarlyFrame();
  }
  return std::nullopt;
}

void MeasurementQueue::rewind(Stamp end, const std::vector<ImuSample>& samples) {
  const auto kept =
      imu_.empty() ? samples.end()
                   : std::lower_bound(samples.begin(), samples.end(), imu_.front().stamp, isBefore);
  imu_.insert(imu_.begin(), samples.begin(), kept);
  end_ = end;
  forgetUntil(end);
}

void MeasurementQueue::dropEarlyFrame() {
  const Stamp stamp = frames_.front().stamp;
  frames_.pop_front();
  if (end_) {
    // td has moved by more than a frame's interval: nothing is left between the two.
    ++dropped_.out_of_order;
  } else {
    ++dropped_.early;
  }
  tellDropped(stamp);
}

FrameMeasurements MeasurementQueue::cutOut(Stamp end, double readout) {
  FrameMeasurements cut;
  cut.frame = std::move(frames_.front());
  frames_.pop_front();
  cut.is_first = !end_;
  cut.restarted = std::exchange(restarted_, false);
  cut.end = end;
  const Stamp lead_in = end - toNanoseconds(options_.lead_in);
  cut.begin = end_ ? *end_ : std::max(lead_in, imu_.front().stamp);
  addSamples(&cut);
  if (readout > 0.0) addReadout(readout, &cut);
  end_ = end;
  forgetUntil(end);
  return cut;
}

void MeasurementQueue::addSamples(FrameMeasurements* cut) const {
  cut->imu.push_back(sampleAt(cut->begin));
  auto sample = std::lower_bound(imu_.begin(), imu_.end(), cut->begin + 1, isBefore);
  Stamp before = sample == imu_.begin() ? cut->begin : std::prev(sample)->stamp;
  for (; sample != imu_.end(); ++sample) {
    // A gap counts whole for every interval that has a part in it.
    cut->longest_gap = std::max(cut->longest_gap, toSeconds(sample->stamp - before));
    before = sample->stamp;
    if (sample->stamp >= cut->end) break;
    cut->imu.push_back(*sample);
  }
  if (cut->end > cut->begin) cut->imu.push_back(sampleAt(cut->end));
  cut->has_gap = cut->longest_gap > options_.gap_periods * period_;
}

void MeasurementQueue::addReadout(double readout, FrameMeasurements* cut) const {
  cut->readout.push_back(sampleAt(cut->end));
  const Stamp last = cut->end + toNanoseconds(readout);
  auto sample = std::lower_bound(imu_.begin(), imu_.end(), cut->end + 1, isBefore);
  for (; sample != imu_.end() && cut->readout.back().stamp < last; ++sample) {
    cut->readout.push_back(*sample);
  }
}

ImuSample MeasurementQueue::sampleAt(Stamp stamp) const {
  const auto after = std::lower_bound(imu_.begin(), imu_.end(), stamp, isBefore);
  if (after->stamp == stamp || after == imu_.begin()) {
    ImuSample sample = *after;
    sample.stamp = stamp;
    return sample;
  }
  return interpolate(*std::prev(after), *after, stamp);
}

void MeasurementQueue::forgetUntil(Stamp stamp) {
  while (imu_.size() > 1 && imu_[1].stamp <= stamp) imu_.pop_front();
}

void MeasurementQueue::tellDisorder(Stamp now) {
  const int count = disorder_.not_finite + disorder_.duplicates + disorder_.out_of_order;
  if (count == 0 || !isDue(now, &disorder_.told)) return;
  std::ostringstream text;
  text << count << " IMU samples dropped: " << disorder_.not_finite << " not finite, "
       << disorder_.duplicates << " double, " << disorder_.out_of_order << " out of order";
  tell(now, Severity::kWarning, "imu_disorder", text.str(),
       {{"not_finite", disorder_.not_finite},
        {"duplicates", disorder_.duplicates},
        {"out_of_order", disorder_.out_of_order}});
  disorder_ = {0, 0, 0, now};
}

void MeasurementQueue::tellDropped(Stamp now) {
  const int count = dropped_.out_of_order + dropped_.ahead + dropped_.early + dropped_.overflown;
  if (count == 0 || !isDue(now, &dropped_.told)) return;
  std::ostringstream text;
  text << count << " frames dropped: " << dropped_.out_of_order << " repeated or out of order, "
       << dropped_.ahead << " with a stamp far ahead, " << dropped_.early
       << " before the first IMU sample, " << dropped_.overflown << " because the queue was full";
  tell(now, Severity::kWarning, "frames_dropped", text.str(),
       {{"out_of_order", dropped_.out_of_order},
        {"ahead", dropped_.ahead},
        {"before_imu", dropped_.early},
        {"queue_full", dropped_.overflown}});
  dropped_ = {0, 0, 0, 0, now};
}

bool MeasurementQueue::isDue(Stamp now, std::optional<Stamp>* told) const {
  // After a jump back the last one lies in a future that does not count.
  if (*told && now < **told - toNanoseconds(options_.max_jump)) told->reset();
  return !*told || toSeconds(now - **told) >= options_.event_interval;
}

void MeasurementQueue::tell(Stamp stamp, Severity severity, const char* code, std::string text,
                            std::vector<std::pair<std::string, double>> figures) {
  events_.push_back({stamp, severity, code, std::move(text), std::move(figures)});
}

std::vector<Event> MeasurementQueue::takeEvents() { return std::exchange(events_, {}); }

void MeasurementQueue::clear() {
  imu_.clear();
  frames_.clear();
  newest_imu_.reset();
  newest_frame_.reset();
  end_.reset();
  restarted_ = false;
}

}  // namespace vins::estimator
