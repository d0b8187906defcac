#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "camera_model/camera.h"

namespace vins::feature_tracker {

/// What CornerGrid looks for.
struct CornerGridOptions {
  int max_corners = 150;       ///< corners that an image may have in all
  double min_distance = 30.0;  ///< between any two of them [px]
  int border = 8;              ///< no corner is nearer to the image's edge [px]
  double quality = 2.5;        ///< smallest score in a noisy image [grey values/px]
};

/// A corner of one image.
struct Corner {
  cv::Point2f pixel;   ///< sub-pixel: the top of a parabola through the scores about the best pixel
  float score = 0.0F;  ///< see CornerGrid
  bool is_shunned = false;  ///< near a place where tracks were lost lately
};

/// Finds corners where an image lacks them. The image is divided into cells, about as many as
/// corners are wanted. Only cells without a corner are searched, and a few of those with one while
/// corners are still missing: other ones at each call, so that all get their turn. A cell that gave
/// nothing is left alone for the next three calls: blank walls are not worth the time.
///
/// A score is the root mean square gradient [grey values/px] in its weakest direction over 8x8
/// pixels: the root of the smaller eigenvalue of the structure tensor (J. Shi, C. Tomasi, "Good
/// features to track", CVPR 1994). It is computed for every second pixel and row; a parabola
/// through a top and its neighbours gives the corner's place between them.
class CornerGrid {
 public:
  /// `mask` is CV_8UC1 of the image's size, zero where no corner may be; or empty.
  CornerGrid(camera_model::ImageSize size, const CornerGridOptions& options, cv::Mat mask);

  /// New corners, best first, of the image with these gradients: CV_16SC2 of Scharr's filter (32
  /// times the grey values per pixel), as cv::buildOpticalFlowPyramid() makes them. With `occupied`
  /// they are at most max_corners.
  /// Those nearer than min_distance to a place in `shunned`, where tracks were lost lately, come
  /// last, and only while the image has less than two thirds of max_corners. `noise`: deviation of
  /// the image's grey values. A score need not be `quality` where less stands out of the noise.
  std::vector<Corner> detect(const cv::Mat& gradients, const std::vector<cv::Point2f>& occupied,
                             const std::vector<cv::Point2f>& shunned = {},
                             double noise = kUnknownNoise);

  /// So much that only `quality` counts [grey values].
  static constexpr double kUnknownNoise = 255.0;

  /// A corner may be at this pixel: neither masked nor too near to the edge.
  bool allows(const cv::Point2f& pixel) const;

 private:
  struct Cell {
    cv::Rect area;
    int corners = 0;
    int rest = 0;  ///< images for which it is not searched, having given nothing
  };

  /// Which corners are near a pixel, by buckets as wide as the smallest distance.
  class Neighbourhood {
   public:
    Neighbourhood(camera_model::ImageSize size, double min_distance);
    void clear();
    void add(const cv::Point2f& pixel);
    bool isFree(const cv::Point2f& pixel) const;

   private:
    cv::Point bucketOf(const cv::Point2f& pixel) const;

    double min_distance_;
    int columns_, rows_;
    std::vector<std::vector<cv::Point2f>> buckets_;
  };

  void countCorners(const std::vector<cv::Point2f>& occupied);
  std::vector<int> cellsToSearch(int missing);
  cv::Size computeScores(const cv::Mat& gradients, const cv::Rect& area);
  void searchCell(const cv::Mat& gradients, const cv::Rect& area, float least_score,
                  std::vector<Corner>* corners);
  void chooseInCell(std::vector<Corner>* corners);
  std::vector<Corner> accept(std::vector<Corner> candidates, int occupied);
  Corner cornerAt(const cv::Rect& area, int row, int column) const;

  camera_model::ImageSize size_;
  CornerGridOptions options_;
  cv::Mat mask_;
  int columns_ = 1;
  std::vector<Cell> cells_;
  std::size_t next_cell_ = 0;
  Neighbourhood neighbourhood_, shunned_;
  // Kept from call to call, so that nothing is allocated for an image.
  cv::Mat1i products_;  ///< xx, xy, yy for each row of blocks
  cv::Mat1i columns_sums_;
  cv::Mat1f squared_scores_;
  std::vector<Corner> found_in_cell_;
};

}  // namespace vins::feature_tracker
