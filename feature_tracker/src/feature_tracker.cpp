#include "feature_tracker/feature_tracker.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "feature_tracker/corner_grid.h"
#include "feature_tracker/flow_prediction.h"
#include "feature_tracker/frame_clock.h"
#include "feature_tracker/image_equalizer.h"
#include "feature_tracker/optical_flow.h"
#include "feature_tracker/outlier_rejection.h"
#include "feature_tracker/stereo_matcher.h"
#include "motion_memory.h"
#include "shunned_places.h"
#include "track_table.h"
#include "vins_core/input_error.h"

namespace vins::feature_tracker {
namespace {

constexpr std::array<std::uint32_t, 2> kBaselines = {3, 9};  // images over which wanderers show
constexpr std::size_t kFewestWitnesses = 30;  // tracks that must be old enough to judge by them
constexpr int kShunnedOutlier = 20;           // images for which a wrong track's place is shunned
constexpr int kShunnedLost = 10;              // and that of a track that was lost
constexpr double kCrowded = 0.5;  // of the distance at detection: nearer tracks are thinned
constexpr double kBrightnessChange = 0.03;  // that optical flow takes without bias worth a pyramid

std::string sizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

/// Why an image cannot be used by this camera; empty where it can.
std::string faultOf(const cv::Mat& image, const camera_model::Camera& camera) {
  const camera_model::ImageSize size = camera.imageSize();
  if (image.empty()) return "the image is empty";
  if (image.type() != CV_8UC1) {
    return "the image has " + std::to_string(image.channels()) + " channels of type " +
           cv::depthToString(image.depth()) + "; needed: 1 of type CV_8U";
  }
  if (image.cols != size.width || image.rows != size.height) {
    return "the image is " + sizeText(image.cols, image.rows) + "; the camera '" + camera.name() +
           "' is calibrated for " + sizeText(size.width, size.height);
  }
  return "";
}

OpticalFlowOptions flowOptions(const FeatureTrackerOptions& options) {
  OpticalFlowOptions flow;
  flow.window = options.window;
  flow.levels = options.pyramid_levels;
  flow.backward_tolerance = options.backward_tolerance;
  return flow;
}

CornerGridOptions gridOptions(const FeatureTrackerOptions& options) {
  return {options.max_features, options.min_distance, options.border, options.corner_quality};
}

OutlierRejectionOptions rejectionOptions(const FeatureTrackerOptions& options) {
  OutlierRejectionOptions rejection;
  rejection.threshold = options.rejection_threshold;
  rejection.seed = options.seed;
  return rejection;
}

}  // namespace

class FeatureTracker::Impl {
 public:
  Impl(std::vector<std::shared_ptr<const camera_model::Camera>> cameras,
       const std::vector<Pose>& T_bc, const FeatureTrackerOptions& options, const cv::Mat& mask)
      : cameras_(std::move(cameras)),
        options_(options),
        clock_(options.max_gap, options.frequency),
        turn_(T_bc.front().rotation),
        equalizer_(options.equalization),
        flow_(flowOptions(options)),
        rejection_(rejectionOptions(options)),
        grid_(cameras_.front()->imageSize(), gridOptions(options), mask),
        table_(cameras_.front()),
        shunned_(cameras_.front()) {
    if (cameras_.size() == 2) {
      stereo_.emplace(cameras_[1], T_bc[1].inverse() * T_bc[0], options.rejection_threshold,
                      flowOptions(options));
    }
  }

  FeatureTrackerResult track(const std::vector<cv::Mat>& images, Stamp stamp,
                             const std::vector<ImuSample>& imu);
  void reset();
  void observeStages(std::function<void(TrackerStage)> observer) {
    observer_ = std::move(observer);
  }

 private:
  bool admit(const std::vector<cv::Mat>& images, Stamp stamp, FeatureTrackerResult* result);
  bool refuseLate(Stamp stamp, FeatureTrackerResult* result);
  void restart(StampVerdict verdict, Stamp stamp, FeatureTrackerResult* result);
  void takeImage(const cv::Mat& image, TrackerStatistics* statistics);
  void followTracks(Stamp stamp, TrackerStatistics* statistics);
  void matchBrightness();
  void rejectOutliers(Stamp stamp, const CameraTurn& turn, TrackerStatistics* statistics);
  void shunLost();
  void dropOutliers(const std::vector<std::uint8_t>& is_inlier);
  void rejectWanderers();
  void addCorners(TrackerStatistics* statistics);
  void matchStereo(const std::vector<cv::Mat>& images, Stamp stamp, FeatureTrackerResult* result);
  void reportHealth(Stamp stamp, FeatureTrackerResult* result);
  void finishStage(TrackerStage stage) const {
    if (observer_) observer_(stage);
  }

  std::vector<std::shared_ptr<const camera_model::Camera>> cameras_;
  FeatureTrackerOptions options_;
  FrameClock clock_;
  TurnPrediction turn_;
  ImageEqualizer equalizer_;
  OpticalFlow flow_;
  OutlierRejection rejection_;
  CornerGrid grid_;
  TrackTable table_;
  MotionMemory memory_;
  ShunnedPlaces shunned_;
  std::optional<StereoMatcher> stereo_;
  std::function<void(TrackerStage)> observer_;

  std::uint32_t sequence_ = 0;
  int late_images_ = 0;
  bool is_lost_ = false;
  ImagePyramid previous_, current_, second_;
  // Kept from image to image, so that little is allocated for an image.
  cv::Mat previous_raw_, adjusted_;
  std::vector<cv::Point2f> pixels_, tracked_;
  std::vector<std::uint8_t> found_;
  std::vector<BearingPair> pairs_;
  std::vector<std::size_t> indices_;
};

void FeatureTracker::Impl::reset() {
  table_.clear();
  shunned_.clear();
  clock_.reset();
  turn_.reset();
  is_lost_ = false;
}

bool FeatureTracker::Impl::admit(const std::vector<cv::Mat>& images, Stamp stamp,
                                 FeatureTrackerResult* result) {
  const auto refuse = [&](const std::string& why) {
    result->events.push_back(
        {stamp, Severity::kError, "image_refused", "image refused: " + why, {}});
    return false;
  };
  const std::string fault =
      images.empty() ? "there is no image" : faultOf(images.front(), *cameras_.front());
  if (!fault.empty()) return refuse(fault);
  const StampVerdict verdict = clock_.judge(stamp);
  if (verdict == StampVerdict::kNegative) return refuse("its stamp is negative");
  if (verdict == StampVerdict::kDuplicate) return refuse("its stamp is that of the image before");
  if (verdict == StampVerdict::kLate) return refuseLate(stamp, result);
  if (verdict == StampVerdict::kBackwards || verdict == StampVerdict::kGap) {
    restart(verdict, stamp, result);
  }
  return true;
}

bool FeatureTracker::Impl::refuseLate(Stamp stamp, FeatureTrackerResult* result) {
  const double late = toSeconds(*clock_.last() - stamp);
  result->events.push_back({stamp,
                            Severity::kWarning,
                            "image_late",
                            "an image came after a newer one; it is left out",
                            {{"late_s", late}, {"count", static_cast<double>(++late_images_)}}});
  return false;
}

/// New tracks; after a jump back in time whoever takes the frames should start again, too.
void FeatureTracker::Impl::restart(StampVerdict verdict, Stamp stamp,
                                   FeatureTrackerResult* result) {
  const double jump = toSeconds(stamp - *clock_.last());
  result->restarted = verdict == StampVerdict::kBackwards;
  if (result->restarted) {
    result->events.push_back({stamp,
                              Severity::kWarning,
                              "tracker_restarted",
                              "the images' time went back; starting again",
                              {{"jump_s", jump}}});
  } else {
    result->events.push_back({stamp,
                              Severity::kWarning,
                              "image_gap",
                              "no image for so long that all tracks are lost; new ones begin",
                              {{"gap_s", jump}}});
  }
  reset();
}

FeatureTrackerResult FeatureTracker::Impl::track(const std::vector<cv::Mat>& images, Stamp stamp,
                                                 const std::vector<ImuSample>& imu) {
  FeatureTrackerResult result;
  const std::uint32_t sequence = sequence_++;
  const bool admitted = admit(images, stamp, &result);
  if (options_.uses_gyroscope) turn_.addSamples(imu);
  if (!admitted) return result;
  takeImage(images.front(), &result.statistics);
  finishStage(TrackerStage::kPyramid);
  followTracks(stamp, &result.statistics);
  addCorners(&result.statistics);
  finishStage(TrackerStage::kDetection);
  matchStereo(images, stamp, &result);
  finishStage(TrackerStage::kStereo);
  result.statistics.mean_track_length = table_.meanLength();
  reportHealth(stamp, &result);
  if (clock_.advance(stamp)) {
    result.frame = FeatureFrame{stamp, sequence, {}};
    table_.observe(&result.frame->observations);
  }
  return result;
}

void FeatureTracker::Impl::takeImage(const cv::Mat& image, TrackerStatistics* statistics) {
  std::swap(previous_, current_);
  const bool was_active = equalizer_.active();
  statistics->equalized = equalizer_.decide(image);
  const auto build = [this](const cv::Mat& raw, ImagePyramid* pyramid) {
    if (!equalizer_.active()) return pyramid->build(raw, flow_.options());
    equalizer_.equalize(raw, &adjusted_);
    pyramid->build(adjusted_, flow_.options());
  };
  // Flow compares grey values: both images of a pair are treated alike.
  if (was_active != equalizer_.active() && table_.size() > 0) build(previous_raw_, &previous_);
  build(image, &current_);
  if (options_.equalization != Equalization::kNever) image.copyTo(previous_raw_);
}

void FeatureTracker::Impl::matchBrightness() {
  const double ratio = brightnessRatio(previous_, current_, pixels_, tracked_);
  if (std::abs(ratio - 1.0) < kBrightnessChange) return;
  previous_.image().convertTo(adjusted_, CV_8U, ratio);
  previous_.build(adjusted_, flow_.options());
}

void FeatureTracker::Impl::followTracks(Stamp stamp, TrackerStatistics* statistics) {
  statistics->before = table_.size();
  CameraTurn turn;
  pairs_.clear();
  if (clock_.last()) {
    const double interval = toSeconds(stamp - *clock_.last());
    turn = turn_.predict(*clock_.last(), stamp);
    table_.pixels(&pixels_);
    table_.predict(turn.R_21, interval, &tracked_);
    matchBrightness();
    flow_.track(previous_, current_, pixels_, &tracked_, &found_);
    table_.align(current_.image(), &tracked_, &found_);
    shunLost();
    table_.advance(tracked_, found_, grid_, turn.R_21, interval, &pairs_);
  }
  statistics->turn_measured = turn.measured;
  statistics->tracked = table_.size();
  finishStage(TrackerStage::kTracking);
  rejectOutliers(stamp, turn, statistics);
  finishStage(TrackerStage::kRejection);
}

void FeatureTracker::Impl::rejectOutliers(Stamp stamp, const CameraTurn& turn,
                                          TrackerStatistics* statistics) {
  if (clock_.last()) {
    const auto measured = turn.measured ? std::make_optional(turn.R_21) : std::nullopt;
    const RejectionResult verdict = rejection_.reject(pairs_, measured, turn.R_21);
    shunned_.nextImage(verdict.motion.R_21);
    dropOutliers(verdict.is_inlier);
    turn_.learn(verdict.motion.R_21, *clock_.last(), stamp);
    memory_.add(verdict.motion.R_21);
    table_.remember(memory_.image());
    rejectWanderers();
  }
  statistics->inliers = table_.size();
  if (statistics->tracked > 0) {
    statistics->inlier_ratio = static_cast<double>(statistics->inliers) / statistics->tracked;
  }
}

void FeatureTracker::Impl::shunLost() {
  for (std::size_t i = 0; i < found_.size(); ++i) {
    if (found_[i] == 0) shunned_.add(table_.tracks()[i].sight.bearing, kShunnedLost);
  }
}

void FeatureTracker::Impl::dropOutliers(const std::vector<std::uint8_t>& is_inlier) {
  for (std::size_t i = 0; i < is_inlier.size(); ++i) {
    if (is_inlier[i] == 0) shunned_.add(table_.tracks()[i].sight.bearing, kShunnedOutlier);
  }
  table_.keep(is_inlier);
}

void FeatureTracker::Impl::rejectWanderers() {
  // In turn, for the sake of time: what one image does not show, the next will.
  const std::uint32_t images = kBaselines[memory_.image() % kBaselines.size()];
  table_.pairsSince(memory_.image(), images, &pairs_, &indices_);
  if (pairs_.size() < kFewestWitnesses) return;
  const RejectionResult verdict =
      rejection_.reject(pairs_, memory_.turnSince(images), memory_.turnSince(images));
  found_.assign(table_.tracks().size(), 1);
  for (std::size_t k = 0; k < indices_.size(); ++k) found_[indices_[k]] = verdict.is_inlier[k];
  dropOutliers(found_);
}

void FeatureTracker::Impl::addCorners(TrackerStatistics* statistics) {
  table_.thinOut(kCrowded * options_.min_distance);
  table_.pixels(&pixels_);
  const std::vector<Corner> corners =
      grid_.detect(current_.gradients(), pixels_, shunned_.pixels(), current_.noise());
  statistics->detected = table_.add(current_.image(), corners);
  table_.remember(memory_.image());
}

void FeatureTracker::Impl::matchStereo(const std::vector<cv::Mat>& images, Stamp stamp,
                                       FeatureTrackerResult* result) {
  if (!stereo_) return;
  const auto forget = [this] {
    for (FeatureTrack& track : table_.tracks()) track.second.reset();
  };
  if (images.size() < 2 || images[1].empty()) return forget();
  const std::string fault = faultOf(images[1], *cameras_[1]);
  if (!fault.empty()) {
    result->events.push_back(
        {stamp, Severity::kError, "image_refused", "second camera's image refused: " + fault, {}});
    return forget();
  }
  if (equalizer_.active()) {
    equalizer_.equalize(images[1], &adjusted_);
    second_.build(adjusted_, flow_.options());
  } else {
    second_.build(images[1], flow_.options());
  }
  const double interval = clock_.last() ? toSeconds(stamp - *clock_.last()) : 0.0;
  result->statistics.stereo = stereo_->match(current_, second_, interval, &table_.tracks());
}

void FeatureTracker::Impl::reportHealth(Stamp stamp, FeatureTrackerResult* result) {
  const bool is_first = !clock_.last();
  const int count = is_first ? table_.size() : result->statistics.inliers;
  const bool is_lost = count < options_.min_tracks;
  if (is_lost != is_lost_) {
    result->events.push_back(
        {stamp,
         is_lost ? Severity::kWarning : Severity::kInfo,
         is_lost ? "tracking_lost" : "tracking_resumed",
         is_lost ? "too few tracks: darkness, blur or nothing to see?" : "enough tracks again",
         {{"tracks", static_cast<double>(count)}}});
  }
  is_lost_ = is_lost;
}

FeatureTracker::FeatureTracker(std::vector<std::shared_ptr<const camera_model::Camera>> cameras,
                               std::vector<Pose> T_bc, const FeatureTrackerOptions& options,
                               cv::Mat mask) {
  options.validate();
  const std::size_t count = cameras.size();
  if (count < 1 || count > 2 || T_bc.size() != count) {
    throw InputError("feature tracker: " + std::to_string(count) + " cameras and " +
                     std::to_string(T_bc.size()) + " poses; allowed: 1 or 2, of each as many");
  }
  const camera_model::ImageSize size = cameras.front()->imageSize();
  const bool mask_fits = mask.empty() || (mask.type() == CV_8UC1 && mask.cols == size.width &&
                                          mask.rows == size.height);
  if (!mask_fits) {
    throw InputError("feature tracker: the mask is " + sizeText(mask.cols, mask.rows) +
                     "; needed: CV_8UC1 of " + sizeText(size.width, size.height));
  }
  impl_ = std::make_unique<Impl>(std::move(cameras), T_bc, options, mask);
}

FeatureTracker::~FeatureTracker() = default;
FeatureTracker::FeatureTracker(FeatureTracker&&) noexcept = default;
FeatureTracker& FeatureTracker::operator=(FeatureTracker&&) noexcept = default;

FeatureTrackerResult FeatureTracker::track(const std::vector<cv::Mat>& images, Stamp stamp,
                                           const std::vector<ImuSample>& imu) {
  return impl_->track(images, stamp, imu);
}

void FeatureTracker::reset() { impl_->reset(); }

void FeatureTracker::observeStages(std::function<void(TrackerStage)> observer) {
  impl_->observeStages(std::move(observer));
}

}  // namespace vins::feature_tracker
