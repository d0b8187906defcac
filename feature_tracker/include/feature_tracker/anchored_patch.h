#pragma once

#include <array>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace vins::feature_tracker {

/// What came of AnchoredPatch::align().
struct PatchAlignment {
  bool inside = false;       ///< the image shows the whole patch; else nothing was done
  cv::Point2f pixel;         ///< where the image shows the middle of the patch
  double correlation = 0.0;  ///< of the grey values, normalized: 1 is the same
};

/// What a corner looked like in the image that it was found in. Aligning later images to it, rather
/// than each image to the one before, keeps a track from drifting; and a patch that looks like
/// nothing seen before tells that the track has slid off, or is none of one surface.
///
/// The patch may shear, turn and grow (affine warp) and change its brightness and contrast.
/// Method: J. Shi, C. Tomasi, "Good features to track", CVPR 1994; inverse compositional steps of
/// S. Baker, I. Matthews, "Lucas-Kanade 20 years on", IJCV 2004, section 3.
class AnchoredPatch {
 public:
  /// Remembers what `image` (CV_8UC1, with at least 12 pixels of memory around it, as pyramids have
  /// them) shows about a pixel.
  void anchor(const cv::Mat& image, const cv::Point2f& pixel);

  /// Finds the patch in another such image, near `start` and warped nearly as it was found last.
  PatchAlignment align(const cv::Mat& image, const cv::Point2f& start);

  /// Size in the image found last by size when remembered.
  double scale() const;

 private:
  static constexpr int kSide = 14;  ///< samples, a pixel apart
  static constexpr int kSamples = kSide * kSide;
  using Samples = std::array<float, kSamples>;
  using Vector6f = Eigen::Matrix<float, 6, 1>;
  using Matrix6f = Eigen::Matrix<float, 6, 6>;

  bool isInside(const cv::Mat& image, const cv::Point2f& pixel) const;
  void sample(const cv::Mat& image, const cv::Point2f& pixel, Samples* samples) const;
  Vector6f gradientOf(const Samples& residuals) const;
  double normalizedResiduals(const Samples& samples, Samples* residuals) const;

  Samples template_;                 ///< grey values without their mean
  Samples gradient_x_, gradient_y_;  ///< [grey values/px]
  float deviation_ = 0.0F;           ///< root of the sum of squares of template_
  Matrix6f inverse_hessian_ = Matrix6f::Zero();
  Eigen::Matrix2f warp_ = Eigen::Matrix2f::Identity();  ///< from the patch to the image
};

}  // namespace vins::feature_tracker
