#include "feature_tracker/image_noise.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

namespace vins::feature_tracker {
namespace {

constexpr int kStep = 4;            // between the pixels that are looked at [px]
constexpr int kLargest = 8 * 255;   // response
constexpr double kRounding = 0.29;  // deviation of rounding to whole grey values: 1 / sqrt(12)
/// Median response of the filter to noise of deviation one: 6 times the median of |N(0, 1)|.
constexpr double kMedianResponse = 6.0 * 0.6745;

/// Second difference along rows of the second difference along columns.
int response(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below) {
  return above[-1] - 2 * above[0] + above[1] - 2 * (here[-1] - 2 * here[0] + here[1]) + below[-1] -
         2 * below[0] + below[1];
}

/// The median of whole numbers by their histogram; each number stands for half a unit around it.
double medianOf(const std::array<int, kLargest + 1>& histogram, int count) {
  int below = 0;
  for (int value = 0; value <= kLargest; ++value) {
    if (2 * (below + histogram[value]) >= count) {
      const double share = (0.5 * count - below) / std::max(1, histogram[value]);
      return std::max(0.0, value - 0.5 + share);
    }
    below += histogram[value];
  }
  return kLargest;
}

}  // namespace

double noiseDeviation(const cv::Mat& image) {
  std::array<int, kLargest + 1> histogram{};
  int count = 0;
  for (int y = kStep / 2; y + 1 < image.rows; y += kStep) {
    const std::uint8_t* above = image.ptr<std::uint8_t>(y - 1);
    const std::uint8_t* here = image.ptr<std::uint8_t>(y);
    const std::uint8_t* below = image.ptr<std::uint8_t>(y + 1);
    for (int x = kStep / 2; x + 1 < image.cols; x += kStep, ++count) {
      ++histogram[std::abs(response(above + x, here + x, below + x))];
    }
  }
  if (count == 0) return kRounding;
  return std::max(kRounding, medianOf(histogram, count) / kMedianResponse);
}

}  // namespace vins::feature_tracker
