#pragma once

#include <opencv2/core.hpp>

namespace vins::feature_tracker {

/// Deviation of an image's noise [grey values], of CV_8UC1, from its own pixels: the median
/// response of a filter that plane and edge leave at zero (J. Immerkaer, "Fast noise variance
/// estimation", CVIU 1996; the median instead of the mean, so that texture does not count). One
/// pixel in 16 is looked at. At least the 0.29 that rounding to grey values has.
double noiseDeviation(const cv::Mat& image);

}  // namespace vins::feature_tracker
