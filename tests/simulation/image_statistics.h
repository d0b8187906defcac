#pragma once

#include <array>
#include <iosfwd>
#include <vector>

#include <opencv2/core.hpp>

#include "simulation/gftt_tracker.h"

namespace vins::simulation {

/// What makes images hard or easy to track. Strengths and gradients are in grey values per pixel;
/// images more than 1000 px wide are halved first, so that 640 x 360 and 1280 x 720 compare.
struct ImageStatistics {
  static constexpr std::array<double, 5> kStrengths = {1.0, 2.0, 4.0, 8.0, 16.0};
  static constexpr std::array<double, 4> kGradientEdges = {0.5, 2.0, 8.0, 32.0};

  int images = 0;
  double mean_grey = 0.0;
  double black_share = 0.0;  ///< of pixels of at most 5 grey values
  double white_share = 0.0;  ///< of pixels of at least 250 grey values
  double noise = 0.0;        ///< standard deviation in flat areas [grey values]
  /// Corners per image, 25 px apart, whose strength (root of the smaller eigenvalue of the
  /// structure tensor, J. Shi, C. Tomasi, "Good features to track", CVPR 1994) is at least
  /// kStrengths[i].
  std::array<double, 5> corners{};
  /// Strength of the corner at these quantiles of an image's corners: 50 %, 75 %, 90 %.
  std::array<double, 3> strength_quantiles{};
  /// Shares of pixels with a gradient below kGradientEdges[0], between them, and above the last.
  std::array<double, 5> gradient_histogram{};
  double sharpness = 0.0;  ///< ratio of the Laplacian's deviation to the gradient's: low is blurred
  double tracks = 0.0;     ///< kept from one image to the next, see countTracks()
};

/// Means over images, one at a time.
class ImageStatisticsMeter {
 public:
  /// A CV_8UC1 image.
  void add(const cv::Mat& image);
  /// The means; all zero without images.
  ImageStatistics result() const;

 private:
  ImageStatistics sum_;
};

/// Tracks of GfttTracker, 25 px apart, over consecutive images.
class TrackCounter {
 public:
  /// Number of tracks that are kept from the last image; nothing to keep in the first.
  int add(const cv::Mat& image);

 private:
  GfttTracker tracker_;
};

/// A line per figure.
std::ostream& operator<<(std::ostream& out, const ImageStatistics& statistics);

}  // namespace vins::simulation
