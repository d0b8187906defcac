#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vins_core/event.h"
#include "vins_core/feature_frame.h"
#include "vins_core/imu.h"
#include "vins_core/time.h"

namespace vins::estimator {

/// Options of the measurement queue.
struct MeasurementQueueOptions {
  int max_frames = 0;        ///< waiting; beyond it the oldest is dropped. 0: no bound (offline)
  double imu_rate = 200.0;   ///< until the samples have told their own [Hz]
  double gap_periods = 2.5;  ///< more time between two samples is a gap: more than one is missing
  double lead_in = 1.0;      ///< samples handed out with a first frame, before it [s]
  double max_jump = 1.0;     ///< a stamp further back is a restarted recording [s]
  double max_lead = 10.0;    ///< a frame further ahead of IMU and last frame has a bad stamp [s]
  double event_interval = 1.0;  ///< between two events on disorder or dropped frames [s of data]

  /// Throws InputError naming the first value that is out of range.
  void validate() const;
};

/// A frame and the inertial samples that lead to it.
struct FrameMeasurements {
  FeatureFrame frame;
  /// From exactly `begin` to exactly `end`, stamps rising; the first and the last are interpolated.
  /// With a first frame: what there is of the time `lead_in` before it.
  std::vector<ImuSample> imu;
  /// After `end`, while the camera read its rows: from exactly `end` to the first at or after
  /// end + readout. Empty without a readout.
  std::vector<ImuSample> readout;
  double undone_readout =
      0.0;                   ///< with which the features were brought to the first row's time [s]
  Stamp begin = 0;           ///< end of the previous frame's interval [ns, the IMU's clock]
  Stamp end = 0;             ///< this frame's stamp + td [ns, the IMU's clock]
  double longest_gap = 0.0;  ///< between neighbouring samples as they came, on the way [s]
  bool has_gap = false;      ///< longest_gap is more than `gap_periods` sample periods
  bool is_first = false;     ///< no interval from a frame before: the start, or restarted
  bool restarted = false;    ///< stamps have jumped back: forget what was before
};

/// Angular acceleration over the last 20 ms of the samples, the gyroscope's axes [rad/s^2].
Eigen::Vector3d angularAcceleration(const std::vector<ImuSample>& samples);

/// Kept by all that look back over several frames, without a copy of the observations.
using SharedMeasurements = std::shared_ptr<const FrameMeasurements>;

/// Pairs feature frames with the IMU samples between them, t_imu = t_cam + td. Puts right what the
/// world does to them: samples that are not finite, double or out of order, gaps, frames before the
/// first sample, repeated frames, restarted recordings. Each is told by an event: imu_disorder,
/// imu_gap, frames_dropped, time_jump.
class MeasurementQueue {
 public:
  explicit MeasurementQueue(const MeasurementQueueOptions& options = {});

  void addImu(const ImuSample& sample);
  void addFrame(FeatureFrame frame);

  /// The oldest frame whose samples have all come, up to `readout` [s] after it. `td` [s] may
  /// change a little from call to call: an interval begins where the one before has ended.
  std::optional<FrameMeasurements> next(double td, double readout = 0.0);

  /// Lets the next interval begin at `end`, which may be before the end of the last one: `samples`
  /// cover what lies between. For frames that were timed anew.
  void rewind(Stamp end, const std::vector<ImuSample>& samples);

  /// What has happened since the last call.
  std::vector<Event> takeEvents();

  /// Forgets samples and frames, but not the sample period.
  void clear();

  std::size_t frameCount() const { return frames_.size(); }
  std::size_t sampleCount() const { return imu_.size(); }
  double imuPeriod() const { return period_; }  ///< median [s]

 private:
  /// What was dropped since it was told, and when that was: at most once in `event_interval`.
  struct ImuDisorder {
    int not_finite = 0, duplicates = 0, out_of_order = 0;
    std::optional<Stamp> told;
  };
  struct DroppedFrames {
    int out_of_order = 0, ahead = 0, early = 0, overflown = 0;
    std::optional<Stamp> told;
  };

  bool acceptImu(const ImuSample& sample);
  void measurePeriod(double period);
  void jumpBack(Stamp from, Stamp to);
  bool isFarAhead(Stamp stamp) const;
  void dropEarlyFrame();
  FrameMeasurements cutOut(Stamp end, double readout);
  void addReadout(double readout, FrameMeasurements* cut) const;
  void addSamples(FrameMeasurements* cut) const;
  ImuSample sampleAt(Stamp stamp) const;
  void forgetUntil(Stamp stamp);
  void tellDisorder(Stamp now);
  void tellDropped(Stamp now);
  bool isDue(Stamp now, std::optional<Stamp>* told) const;
  void tell(Stamp stamp, Severity severity, const char* code, std::string text,
            std::vector<std::pair<std::string, double>> figures);

  MeasurementQueueOptions options_;
  std::deque<ImuSample> imu_;  ///< from the last one not after the last interval's end
  std::deque<FeatureFrame> frames_;
  std::vector<Event> events_;
  std::optional<Stamp> newest_imu_;
  std::optional<Stamp> newest_frame_;
  std::optional<Stamp> end_;  ///< of the last interval
  std::vector<double> periods_;
  double period_;
  bool period_measured_ = false;
  ImuDisorder disorder_;
  DroppedFrames dropped_;
  bool restarted_ = false;
};

}  // namespace vins::estimator
