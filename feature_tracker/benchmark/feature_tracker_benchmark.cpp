// Cost of the feature tracker's stages on EuRoC's MH_01 (where it is found, see shared_data.h), and
// how long its tracks last. One image per iteration; reading images is not timed. With
// VINS_TRACK_PICTURE=FILE.png the tracks of the last image are drawn.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <numeric>

#include <benchmark/benchmark.h>
#include <opencv2/imgcodecs.hpp>

#include "feature_tracker/feature_tracker.h"
#include "feature_tracker/track_drawing.h"
#include "image_sequence.h"
#include "vins_core/resident_memory.h"

namespace {

using vins::feature_tracker::TrackerStage;
using vins::feature_tracker::testing::ImageSequence;

constexpr std::size_t kStages = 5;

/// Milliseconds of all images, of one stage or of the whole.
class Times {
 public:
  void add(double ms) { ms_.push_back(ms); }
  double mean() const {
    return ms_.empty() ? 0.0 : std::accumulate(ms_.begin(), ms_.end(), 0.0) / ms_.size();
  }
  double percentile95() const {
    if (ms_.empty()) return 0.0;
    std::vector<double> sorted = ms_;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() * 95 / 100];
  }

 private:
  std::vector<double> ms_;
};

/// The time that this thread has computed, whatever else the machine does: the tracker has no other
/// thread.
struct ThreadClock {
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<ThreadClock, duration>;

  static time_point now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return time_point(std::chrono::seconds(time.tv_sec) + duration(time.tv_nsec));
  }
};

/// Reads the clock at the end of each stage.
class StageClock {
 public:
  using Clock = ThreadClock;

  void start() { begin_ = last_ = Clock::now(); }
  void stageEnds(TrackerStage stage) {
    const auto now = Clock::now();
    stages_[static_cast<std::size_t>(stage)].add(ms(now - last_));
    last_ = now;
  }
  double imageEnds() {
    const double whole = ms(Clock::now() - begin_);
    whole_.add(whole);
    return whole;
  }

  void report(benchmark::State& state) const {
    const std::array<const char*, kStages> names = {"pyramid", "track", "reject", "detect",
                                                    "stereo"};
    for (std::size_t i = 0; i + 1 < kStages; ++i) {
      state.counters[std::string(names[i]) + "_ms"] = stages_[i].mean();
      state.counters[std::string(names[i]) + "_p95"] = stages_[i].percentile95();
    }
    state.counters["whole_ms"] = whole_.mean();
    state.counters["whole_p95"] = whole_.percentile95();
  }

 private:
  static double ms(Clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
  }

  Clock::time_point begin_, last_;
  std::array<Times, kStages> stages_;
  Times whole_;
};

/// How the tracks fared, over all images but the first.
struct TrackBook {
  double images = 0.0, survivors = 0.0, inlier_ratio = 0.0, features = 0.0, mean_length = 0.0;
  std::map<std::int64_t, int> lengths;  ///< of every track that there was, at its end

  void add(const vins::feature_tracker::FeatureTrackerResult& result) {
    for (const auto& observation : result.frame->observations) {
      lengths[observation.id] = observation.track_length;
    }
    if (result.statistics.before == 0) return;
    images += 1.0;
    survivors += static_cast<double>(result.statistics.inliers) / result.statistics.before;
    inlier_ratio += result.statistics.inlier_ratio;
    features += static_cast<double>(result.frame->observations.size());
    mean_length += result.statistics.mean_track_length;
  }

  void report(benchmark::State& state) const {
    std::vector<int> ended;
    for (const auto& item : lengths) ended.push_back(item.second);
    std::sort(ended.begin(), ended.end());
    state.counters["features"] = features / images;
    state.counters["survivors"] = survivors / images;
    state.counters["inlier_ratio"] = inlier_ratio / images;
    state.counters["mean_age"] = mean_length / images;
    state.counters["mean_lifetime"] =
        std::accumulate(ended.begin(), ended.end(), 0.0) / static_cast<double>(ended.size());
    state.counters["median_lifetime"] = ended[ended.size() / 2];
  }
};

void drawIfAsked(const ImageSequence& sequence, std::size_t i, const vins::FeatureFrame& frame) {
  const char* path = std::getenv("VINS_TRACK_PICTURE");
  if (path == nullptr) return;
  cv::imwrite(path,
              vins::feature_tracker::drawTracks(sequence.image(i), frame, *sequence.camera()));
}

vins::feature_tracker::FeatureTracker makeTracker(
    const ImageSequence& sequence, const vins::feature_tracker::FeatureTrackerOptions& options) {
  return vins::feature_tracker::FeatureTracker({sequence.camera()}, {sequence.bodyToCamera()},
                                               options);
}

/// Every image of the sequence; `gyroscope`: with its samples.
void trackSequence(benchmark::State& state, bool gyroscope, bool equalize) {
  cv::setNumThreads(1);
  const auto sequence = vins::feature_tracker::testing::measuredSequence();
  vins::feature_tracker::FeatureTrackerOptions options;
  if (equalize) options.equalization = vins::feature_tracker::Equalization::kWhereDull;
  vins::feature_tracker::FeatureTracker tracker = makeTracker(*sequence, options);
  StageClock clock;
  TrackBook book;
  tracker.observeStages([&clock](TrackerStage stage) { clock.stageEnds(stage); });
  std::size_t i = 0;
  vins::feature_tracker::FeatureTrackerResult result;
  for (auto _ : state) {
    const cv::Mat image = sequence->image(i);
    const vins::Stamp stamp = sequence->stamp(i);
    const vins::Stamp before = i == 0 ? stamp - 50'000'000 : sequence->stamp(i - 1);
    const auto imu = gyroscope ? sequence->imu(before, stamp) : std::vector<vins::ImuSample>();
    clock.start();
    result = tracker.track({image}, stamp, imu);
    state.SetIterationTime(1e-3 * clock.imageEnds());
    book.add(result);
    i = (i + 1) % sequence->size();
  }
  drawIfAsked(*sequence, (i + sequence->size() - 1) % sequence->size(), *result.frame);
  clock.report(state);
  book.report(state);
  state.SetLabel(sequence->name());
}

/// Memory over a long run: of the second half, after the first one has reached its level.
void memoryOverALongRun(benchmark::State& state) {
  cv::setNumThreads(1);
  const auto sequence = vins::feature_tracker::testing::measuredSequence();
  std::vector<cv::Mat> images;
  for (std::size_t i = 0; i < std::min<std::size_t>(100, sequence->size()); ++i) {
    images.push_back(sequence->image(sequence->size() - 1 - i));
  }
  for (auto _ : state) {
    vins::feature_tracker::FeatureTracker tracker = makeTracker(*sequence, {});
    constexpr std::size_t kImages = 4000;
    double half_way = 0.0;
    for (std::size_t i = 0; i < kImages; ++i) {
      if (i == kImages / 2) half_way = vins::residentMegabytes();
      // To and fro, so that there is no jump where the images begin again.
      const std::size_t turn = i % (2 * images.size() - 2);
      const std::size_t k = turn < images.size() ? turn : 2 * images.size() - 2 - turn;
      tracker.track({images[k]}, 50'000'000 * static_cast<vins::Stamp>(i + 1), {});
    }
    state.counters["rss_MB"] = half_way;
    state.counters["growth_MB"] = vins::residentMegabytes() - half_way;
  }
}

void registerAll() {
  const auto images = static_cast<benchmark::IterationCount>(
      vins::feature_tracker::testing::measuredSequence()->size());
  const auto add = [images](const char* name, bool gyroscope, bool equalize) {
    benchmark::RegisterBenchmark(name, trackSequence, gyroscope, equalize)
        ->Iterations(images)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  };
  add("track/gyroscope", true, false);
  add("track/vision_only", false, false);
  add("track/equalize", true, true);
  benchmark::RegisterBenchmark("memory", memoryOverALongRun)
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  registerAll();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
