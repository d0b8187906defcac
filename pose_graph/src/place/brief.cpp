#include "pose_graph/place/brief.h"

#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>

#include <opencv2/imgproc.hpp>

#include "vins_core/input_error.h"
#include "vins_core/parameters.h"

namespace vins::pose_graph {
namespace {

constexpr int kLargestOffset = 127;
constexpr double kSmoothingSigma = 2.0;  // [px], with the window of 9: Calonder et al., section 3.1
constexpr int kSmoothingWindow = 9;

/// An offset from a Gaussian about zero, cut off at the patch's edge: drawn evenly, and kept as
/// often as the Gaussian is high. So the standard library's distributions, which differ from
/// computer to computer, are not needed.
cv::Point drawOffset(double sigma, int radius, std::mt19937_64* random) {
  const auto uniform = [random] { return static_cast<double>((*random)() >> 11) * 0x1.0p-53; };
  for (;;) {
    const int x = static_cast<int>(uniform() * (2 * radius + 1)) - radius;
    const int y = static_cast<int>(uniform() * (2 * radius + 1)) - radius;
    if (uniform() < std::exp(-0.5 * (x * x + y * y) / (sigma * sigma))) return {x, y};
  }
}

std::array<int, kDescriptorBits> readOffsets(const Parameters& file, const std::string& key) {
  const std::vector<double> numbers = file.numbers(key, {kDescriptorBits});
  std::array<int, kDescriptorBits> offsets{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::abs(numbers[i]) > kLargestOffset || numbers[i] != std::round(numbers[i])) {
      std::ostringstream found;
      found << numbers[i];
      file.fail(key, found.str(), "whole numbers from -127 to 127");
    }
    offsets[i] = static_cast<int>(numbers[i]);
  }
  return offsets;
}

template <typename Choose>
void writeList(const char* key, const std::array<BriefPattern::Pair, kDescriptorBits>& pairs,
               const Choose& choose, std::ostream& out) {
  out << key << ": [";
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    out << (i == 0 ? " " : i % 16 == 0 ? ",\n   " : ", ") << choose(pairs[i]);
  }
  out << " ]\n";
}

}  // namespace

BriefPattern::BriefPattern(const std::array<Pair, kDescriptorBits>& pairs) : pairs_(pairs) {
  for (const Pair& pair : pairs_) {
    for (const cv::Point& end : {pair.first, pair.second}) {
      radius_ = std::max({radius_, std::abs(end.x), std::abs(end.y)});
    }
  }
}

BriefPattern BriefPattern::generate(std::uint64_t seed, int patch_size) {
  if (patch_size < 9 || patch_size > 2 * kLargestOffset + 1) {
    throw InputError("BRIEF pattern: patch size is " + std::to_string(patch_size) +
                     "; allowed: 9 to 255");
  }
  std::mt19937_64 random(seed);
  const int radius = (patch_size - 1) / 2;
  std::array<Pair, kDescriptorBits> pairs;
  for (Pair& pair : pairs) {
    do {
      pair.first = drawOffset(patch_size / 5.0, radius, &random);
      pair.second = drawOffset(patch_size / 5.0, radius, &random);
    } while (pair.first == pair.second);
  }
  return BriefPattern(pairs);
}

BriefPattern BriefPattern::load(const std::string& path) {
  const Parameters file = Parameters::load(path);
  const auto x1 = readOffsets(file, "x1"), y1 = readOffsets(file, "y1");
  const auto x2 = readOffsets(file, "x2"), y2 = readOffsets(file, "y2");
  std::array<Pair, kDescriptorBits> pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i] = {{x1[i], y1[i]}, {x2[i], y2[i]}};
  return BriefPattern(pairs);
}

std::string BriefPattern::toYaml() const {
  std::ostringstream out;
  out << "%YAML:1.0\n---\n"
      << "# BRIEF's 256 pairs of pixels: offsets from the corner [px].\n";
  writeList(
      "x1", pairs_, [](const Pair& pair) { return pair.first.x; }, out);
  writeList(
      "y1", pairs_, [](const Pair& pair) { return pair.first.y; }, out);
  writeList(
      "x2", pairs_, [](const Pair& pair) { return pair.second.x; }, out);
  writeList(
      "y2", pairs_, [](const Pair& pair) { return pair.second.y; }, out);
  return out.str();
}

DescribedPixels BriefExtractor::describe(const cv::Mat& image,
                                         const std::vector<cv::Point2f>& pixels) const {
  if (image.type() != CV_8UC1) throw InputError("BRIEF: the image is not CV_8UC1");
  cv::Mat1b smooth;
  cv::GaussianBlur(image, smooth, {kSmoothingWindow, kSmoothingWindow}, kSmoothingSigma);
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(smooth.step);
  std::array<std::array<std::ptrdiff_t, 2>, kDescriptorBits> offsets;
  for (std::size_t bit = 0; bit < offsets.size(); ++bit) {
    const BriefPattern::Pair& pair = pattern_.pairs()[bit];
    offsets[bit] = {pair.first.y * step + pair.first.x, pair.second.y * step + pair.second.x};
  }
  const cv::Rect inside(border(), border(), smooth.cols - 2 * border(), smooth.rows - 2 * border());
  DescribedPixels result;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const cv::Point pixel(cvRound(pixels[i].x), cvRound(pixels[i].y));
    if (!inside.contains(pixel)) continue;
    const std::uint8_t* centre = smooth.ptr(pixel.y) + pixel.x;
    BriefDescriptor descriptor{};
    for (std::size_t bit = 0; bit < offsets.size(); ++bit) {
      const bool darker = centre[offsets[bit][0]] < centre[offsets[bit][1]];
      descriptor[bit / 64] |= static_cast<std::uint64_t>(darker) << (bit % 64);
    }
    result.indices.push_back(i);
    result.descriptors.push_back(descriptor);
  }
  return result;
}

}  // namespace vins::pose_graph
