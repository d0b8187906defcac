#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "camera_model/camera.h"

namespace vins::feature_tracker {

/// How OpticalFlow follows points.
struct OpticalFlowOptions {
  int window = 16;                  ///< side of the patch that is compared [px]
  int levels = 4;                   ///< images in a pyramid, the original included
  int iterations = 8;               ///< at most, per level: AnchoredPatch does the fine work
  double step = 0.1;                ///< a level is done when it moves less than this [px]
  double backward_tolerance = 0.7;  ///< between a point and its track's way back [px]
};

/// An image, its halves and quarters, and the gradients of each: made once per image, and used with
/// the image before and the one after.
class ImagePyramid {
 public:
  /// Takes the image (CV_8UC1) in; memory of an earlier one of this size is used again.
  void build(const cv::Mat& image, const OpticalFlowOptions& options);

  bool empty() const { return levels_.empty(); }
  const cv::Mat& image() const { return levels_[0]; }

  /// CV_16SC2 by Scharr's filter: 32 times the grey values per pixel.
  const cv::Mat& gradients() const { return levels_[1]; }

  /// The smallest image; a pixel of it is coarseScale() pixels wide.
  const cv::Mat& coarsest() const { return levels_[levels_.size() - 2]; }
  double coarseScale() const;

  /// Deviation of the image's noise [grey values]; see noiseDeviation().
  double noise() const { return noise_; }

  /// Image and gradients in turn, as cv::calcOpticalFlowPyrLK() takes them.
  const std::vector<cv::Mat>& levels() const { return levels_; }

 private:
  std::vector<cv::Mat> levels_;
  double noise_ = 0.0;
};

/// Follows points from one image to another by the pyramidal method of Lucas and Kanade (J.-Y.
/// Bouguet, "Pyramidal implementation of the Lucas Kanade feature tracker", Intel, 2000), and back
/// again: a point counts as found only if it comes back to where it started (Z. Kalal et al.,
/// "Forward-backward error", ICPR 2010).
class OpticalFlow {
 public:
  explicit OpticalFlow(const OpticalFlowOptions& options) : options_(options) {}

  /// For each of `points` in the image `from`: where it is in the image `to`. On entry `tracked`
  /// are predictions. Points that are not found near their predictions are sought again from their
  /// places in `from`. found[i] is 1 or 0.
  void track(const ImagePyramid& from, const ImagePyramid& to,
             const std::vector<cv::Point2f>& points, std::vector<cv::Point2f>* tracked,
             std::vector<std::uint8_t>* found);

  const OpticalFlowOptions& options() const { return options_; }

 private:
  void trackThere(const ImagePyramid& from, const ImagePyramid& to,
                  const std::vector<cv::Point2f>& points, std::vector<cv::Point2f>* tracked,
                  std::vector<std::uint8_t>* found);
  void checkWayBack(const ImagePyramid& from, const ImagePyramid& to,
                    const std::vector<cv::Point2f>& points, const std::vector<cv::Point2f>& tracked,
                    std::vector<std::uint8_t>* found);
  void retryLost(const ImagePyramid& from, const ImagePyramid& to,
                 const std::vector<cv::Point2f>& points, std::vector<cv::Point2f>* tracked,
                 std::vector<std::uint8_t>* found);

  OpticalFlowOptions options_;
  // Kept from call to call, so that nothing is allocated for an image.
  std::vector<cv::Point2f> back_;
  std::vector<std::uint8_t> found_back_;
  std::vector<float> residuals_;
};

/// Factor between the brightnesses of two images about the same points, as the median over them of
/// the ratio of grey values at the coarsest level: above 1 where `to` is brighter. 1 where fewer
/// than 10 points can be compared.
double brightnessRatio(const ImagePyramid& from, const ImagePyramid& to,
                       const std::vector<cv::Point2f>& points,
                       const std::vector<cv::Point2f>& tracked);

}  // namespace vins::feature_tracker
