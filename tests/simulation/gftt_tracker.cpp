#include "simulation/gftt_tracker.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace vins::simulation {
namespace {

constexpr double kWayBack_px = 0.5;

}  // namespace

int GfttTracker::add(const cv::Mat& image) {
  if (!last_.empty() && !tracks_.empty()) follow(image);
  const int followed = static_cast<int>(tracks_.size());
  replenish(image);
  last_ = image.clone();
  return followed;
}

void GfttTracker::follow(const cv::Mat& image) {
  std::vector<cv::Point2f> before, now, back;
  for (const GfttTrack& track : tracks_) before.push_back(track.pixel);
  std::vector<std::uint8_t> found, returned;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(last_, image, before, now, found, error);
  cv::calcOpticalFlowPyrLK(image, last_, now, back, returned, error);
  const cv::Rect2f inside(1.0F, 1.0F, static_cast<float>(image.cols - 2),
                          static_cast<float>(image.rows - 2));
  std::vector<GfttTrack> kept;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const bool same = cv::norm(back[i] - before[i]) < kWayBack_px;
    if (found[i] && returned[i] && same && inside.contains(now[i])) {
      kept.push_back({tracks_[i].id, now[i]});
    }
  }
  tracks_ = kept;
}

void GfttTracker::replenish(const cv::Mat& image) {
  const int missing = options_.max_corners - static_cast<int>(tracks_.size());
  if (missing <= 0) return;
  cv::Mat mask(image.size(), CV_8UC1, cv::Scalar(255));
  for (const GfttTrack& track : tracks_) {
    cv::circle(mask, track.pixel, static_cast<int>(options_.min_distance), cv::Scalar(0),
               cv::FILLED);
  }
  std::vector<cv::Point2f> more;
  cv::goodFeaturesToTrack(image, more, missing, options_.quality, options_.min_distance, mask);
  for (const cv::Point2f& pixel : more) tracks_.push_back({next_id_++, pixel});
}

}  // namespace vins::simulation
