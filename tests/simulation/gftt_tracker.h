#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace vins::simulation {

/// What GfttTracker is asked for.
struct GfttTrackerOptions {
  int max_corners = 150;
  double min_distance = 25.0;  ///< between corners at detection [px]
  double quality = 0.01;       ///< of the weakest corner, as a share of the image's best
};

/// A corner followed by GfttTracker.
struct GfttTrack {
  std::int64_t id = 0;
  cv::Point2f pixel;
};

/// The textbook's front end, to compare with: cv::goodFeaturesToTrack() where corners are missing,
/// pyramidal Lucas-Kanade, kept where tracking back returns within half a pixel. No track is ever
/// dropped because the camera's motion doesn't explain it.
class GfttTracker {
 public:
  explicit GfttTracker(const GfttTrackerOptions& options = {}) : options_(options) {}

  /// Follows the tracks into the next image (CV_8UC1) and adds corners that are missing; returns
  /// how many tracks were followed.
  int add(const cv::Mat& image);

  /// The tracks in the latest image, new ones last.
  const std::vector<GfttTrack>& tracks() const { return tracks_; }

 private:
  void follow(const cv::Mat& image);
  void replenish(const cv::Mat& image);

  GfttTrackerOptions options_;
  cv::Mat last_;
  std::vector<GfttTrack> tracks_;
  std::int64_t next_id_ = 0;
};

}  // namespace vins::simulation
