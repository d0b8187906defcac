#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "camera_model/camera.h"
#include "feature_tracker/corner_grid.h"
#include "feature_tracker/feature_track.h"
#include "feature_tracker/outlier_rejection.h"
#include "vins_core/feature_frame.h"

namespace vins::feature_tracker {

/// The tracks of the first camera, oldest first, and what is done to all of them at once.
class TrackTable {
 public:
  explicit TrackTable(std::shared_ptr<const camera_model::Camera> camera)
      : camera_(std::move(camera)) {}

  std::vector<FeatureTrack>& tracks() { return tracks_; }
  const std::vector<FeatureTrack>& tracks() const { return tracks_; }
  int size() const { return static_cast<int>(tracks_.size()); }

  void pixels(std::vector<cv::Point2f>* pixels) const;

  /// Where the tracks will be `interval` [s] later, after a turn: turned bearing plus drift.
  void predict(const Eigen::Quaterniond& R_21, double interval,
               std::vector<cv::Point2f>* predicted) const;

  /// Moves the pixels of tracks that were found to where the image shows what they looked like at
  /// first; those that look otherwise now count as not found.
  void align(const cv::Mat& image, std::vector<cv::Point2f>* pixels,
             std::vector<std::uint8_t>* found);

  /// Moves the tracks that were found to their new pixels, and drops the others, those where
  /// `grid` allows no corner, and those without a bearing. `pairs` are the bearings before and now
  /// of the tracks that are left.
  void advance(const std::vector<cv::Point2f>& pixels, const std::vector<std::uint8_t>& found,
               const CornerGrid& grid, const Eigen::Quaterniond& R_21, double interval,
               std::vector<BearingPair>* pairs);

  /// Writes the bearings down as those of image number `image`.
  void remember(std::uint32_t image);

  /// Bearings of image number `image` - `ago` and now, of the tracks that are as old as that; their
  /// places in tracks() are `indices`.
  void pairsSince(std::uint32_t image, std::uint32_t ago, std::vector<BearingPair>* pairs,
                  std::vector<std::size_t>* indices) const;

  /// Keeps the tracks that are marked with 1.
  void keep(const std::vector<std::uint8_t>& marks);

  /// Of tracks that have come nearer to each other than `distance` [px] the older one stays.
  void thinOut(double distance);

  /// Adds a track for each corner of `image` that has a bearing; returns how many.
  int add(const cv::Mat& image, const std::vector<Corner>& corners);

  double meanLength() const;

  /// The tracks as observations: those of the first camera, then those of the second.
  void observe(std::vector<FeatureObservation>* observations) const;

  void clear() { tracks_.clear(); }

 private:
  bool move(FeatureTrack* track, const cv::Point2f& pixel, const Eigen::Quaterniond& R_21,
            double interval) const;

  std::shared_ptr<const camera_model::Camera> camera_;
  std::vector<FeatureTrack> tracks_;
  std::int64_t next_id_ = 0;  ///< never goes back, so that no id is used twice
};

}  // namespace vins::feature_tracker
