#include "simulation/frame_timing.h"

#include <algorithm>

#include "simulation/random.h"
#include "vins_core/option_check.h"

namespace vins::simulation {
namespace {

constexpr double kLeastInterval = 0.001;  ///< between stamps [s]
constexpr double kEnd = 1e-9;             ///< an image on the end still belongs to it [s]

void requireRange(const char* name, double value, double min, double max, const char* allowed) {
  if (!(value >= min && value <= max)) refuseOption("frame timing", name, value, allowed);
}

/// Whether the camera runs at its slow rate, by stretches of 2 to 6 s.
class Stretches {
 public:
  explicit Stretches(Random* random) : random_(random), end_s_(random->uniform(2.0, 6.0)) {}

  bool slowAt(double t_s) {
    while (t_s >= end_s_) {
      end_s_ += random_->uniform(2.0, 6.0);
      slow_ = !slow_;
    }
    return slow_;
  }

 private:
  Random* random_;
  double end_s_;
  bool slow_ = false;
};

}  // namespace

void FrameTiming::validate() const {
  requireRange("rate", rate, 0.1, 1000.0, "0.1 to 1000 Hz");
  requireRange("slow rate", slow_rate, 0.0, 1000.0, "0 to 1000 Hz");
  requireRange("drop probability", drop_probability, 0.0, 0.9, "0 to 0.9");
  requireRange("burst probability", burst_probability, 0.0, 0.9, "0 to 0.9");
  requireRange("stamp jitter", stamp_jitter_s, 0.0, 0.1, "0 to 0.1 s");
}

std::vector<FrameInstant> frameInstants(const FrameTiming& timing, double duration,
                                        std::uint64_t seed) {
  timing.validate();
  Random random(seed, "frame timing");
  Random stretch_random(seed, "frame timing stretches");
  Stretches stretches(&stretch_random);
  std::vector<FrameInstant> instants;
  double origin = 0.0;  // of the grid of images at the present rate
  int since_origin = 0, lost = 0;
  double rate = timing.rate;
  for (double t = 0.0; t <= duration + kEnd; t = origin + ++since_origin / rate) {
    const double now =
        timing.slow_rate > 0.0 && stretches.slowAt(t) ? timing.slow_rate : timing.rate;
    if (now != rate) {
      rate = now;
      origin = t;
      since_origin = 0;
    }
    const double drop = random.uniform(), burst = random.uniform(), jitter = random.normal();
    if (burst < timing.burst_probability)
      lost = 2 + static_cast<int>(5.0 * burst / timing.burst_probability);
    const bool dropped = lost > 0 || drop < timing.drop_probability;
    lost = std::max(0, lost - 1);
    if (instants.empty()) {
      instants.push_back({t, t});
    } else if (!dropped) {
      const double least = instants.back().stamped_s + kLeastInterval;
      instants.push_back({t, std::max(least, t + timing.stamp_jitter_s * jitter)});
    }
  }
  return instants;
}

}  // namespace vins::simulation
