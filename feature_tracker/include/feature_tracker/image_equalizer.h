#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "feature_tracker/tracker_options.h"

namespace vins::feature_tracker {

/// Range of grey values between the darkest and the brightest tenth of an image (CV_8UC1), from
/// one pixel in 64.
int greyRange(const cv::Mat& image);

/// Stretches the local contrast of dull images (CLAHE: K. Zuiderveld, Graphics Gems IV, 1994).
class ImageEqualizer {
 public:
  explicit ImageEqualizer(Equalization mode);

  /// Whether this image needs it. With hysteresis: begins below a grey range of 60, ends above 80,
  /// since each change costs a second pyramid of the image before.
  bool decide(const cv::Mat& image);

  /// CLAHE of an image; only where decide() said so.
  void equalize(const cv::Mat& image, cv::Mat* equalized) { clahe_->apply(image, *equalized); }

  bool active() const { return active_; }

 private:
  Equalization mode_;
  bool active_ = false;
  cv::Ptr<cv::CLAHE> clahe_;
};

}  // namespace vins::feature_tracker
