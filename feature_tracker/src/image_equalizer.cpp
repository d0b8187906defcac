#include "feature_tracker/image_equalizer.h"

#include <array>
#include <cstdint>

namespace vins::feature_tracker {
namespace {

constexpr int kDull = 60;   // grey range below which CLAHE begins
constexpr int kVivid = 80;  // grey range above which it ends
constexpr double kClipLimit = 3.0;

/// Grey value below which a share of the counted pixels lies.
int quantile(const std::array<int, 256>& histogram, int count) {
  int sum = 0;
  int grey = 0;
  while (grey < 255 && (sum += histogram[grey]) <= count) ++grey;
  return grey;
}

}  // namespace

int greyRange(const cv::Mat& image) {
  constexpr int kStep = 8;
  std::array<int, 256> histogram{};
  int pixels = 0;
  for (int y = kStep / 2; y < image.rows; y += kStep) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(y);
    for (int x = kStep / 2; x < image.cols; x += kStep) ++histogram[row[x]], ++pixels;
  }
  return quantile(histogram, pixels * 9 / 10) - quantile(histogram, pixels / 10);
}

ImageEqualizer::ImageEqualizer(Equalization mode)
    : mode_(mode), clahe_(cv::createCLAHE(kClipLimit, cv::Size(8, 8))) {}

bool ImageEqualizer::decide(const cv::Mat& image) {
  if (mode_ == Equalization::kNever) return false;
  active_ = greyRange(image) < (active_ ? kVivid : kDull);
  return active_;
}

}  // namespace vins::feature_tracker
