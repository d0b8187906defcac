#include "simulation/texture.h"

#include <cmath>
#include <cstring>
#include <string>

#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

/// Longer ellipses are filtered as if their short axis were a quarter of the long one: blurred
/// rather than aliased.
constexpr float kMaxElongation = 4.0F;
/// Between two levels the finer one has more detail than a pixel can show; half a level more keeps
/// it from aliasing.
constexpr float kLevelBias = 0.5F;
/// Taken off each side tap's weight, so that taps of little weight vanish, and do so gradually.
constexpr double kIdleWeight = 0.04;

/// Base-2 logarithm, piecewise linear between powers of two: continuous, and fast.
float roughLog2(float x) {
  std::int32_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  return static_cast<float>(bits - (127 << 23)) * 0x1.0p-23F;
}

bool isPowerOfTwo(int n) { return n > 0 && (n & (n - 1)) == 0; }

/// Half as wide, through [1 3 3 1] / 8, periodic.
cv::Mat halvedWidth(const cv::Mat& image) {
  if (image.cols == 1) return image;
  const int n = image.cols;
  cv::Mat half(image.rows, n / 2, CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    const float* const in = image.ptr<float>(y);
    float* const out = half.ptr<float>(y);
    const auto filtered = [in](int before, int first, int after) {
      return 0.125F * (3.0F * (in[first] + in[first + 1]) + in[before] + in[after]);
    };
    out[0] = filtered(n - 1, 0, 2 % n);
    for (int x = 1; x + 1 < n / 2; ++x) out[x] = filtered(2 * x - 1, 2 * x, 2 * x + 2);
    if (n > 2) out[n / 2 - 1] = filtered(n - 3, n - 2, 0);
  }
  return half;
}

cv::Mat halved(const cv::Mat& image) { return halvedWidth(halvedWidth(image).t()).t(); }

}  // namespace

FootprintFilter::FootprintFilter() : by_elongation_(kEntries) {
  for (int entry = 0; entry < kEntries; ++entry) {
    const double elongation = 1.0 + (kMaxElongation - 1.0) * entry / (kEntries - 1);
    // A box of that length has this much more variance than one of length 1.
    const double variance = (elongation * elongation - 1.0) / 12.0;
    Footprint& footprint = by_elongation_[entry];
    double sum = 1.0;
    for (int tap = 1; tap <= 3 && variance > 0.0; ++tap) {
      const double weight = std::exp(-0.5 * tap * tap / variance) - kIdleWeight;
      if (weight <= 0.0) break;
      footprint.side_taps = tap;
      footprint.weights[tap - 1] = static_cast<float>(weight);
      sum += 2.0 * weight;
    }
    footprint.centre_weight = static_cast<float>(1.0 / sum);
    for (float& weight : footprint.weights) weight /= static_cast<float>(sum);
  }
}

Footprint FootprintFilter::footprint(float x_u, float y_u, float x_v, float y_v) const {
  // Axes of the ellipse that the unit circle of pixels maps to: eigenvalues of J J^T.
  const float xx = x_u * x_u + x_v * x_v;
  const float yy = y_u * y_u + y_v * y_v;
  const float xy = x_u * y_u + x_v * y_v;
  const float mean = 0.5F * (xx + yy);
  const float difference = 0.5F * (xx - yy);
  const float spread = std::sqrt(difference * difference + xy * xy);
  const float longest = std::sqrt(mean + spread);
  const float shortest =
      std::max({std::sqrt(std::max(mean - spread, 0.0F)), longest / kMaxElongation, 1e-6F});
  const float entry =
      (longest / shortest - 1.0F) * (static_cast<float>(kEntries - 1) / (kMaxElongation - 1.0F));
  const int index = std::min(std::max(static_cast<int>(entry + 0.5F), 0), kEntries - 1);
  Footprint result = by_elongation_[index];
  result.level = roughLog2(shortest) + kLevelBias;
  if (result.side_taps == 0) return result;
  float axis_x = difference >= 0.0F ? difference + spread : xy;
  float axis_y = difference >= 0.0F ? xy : spread - difference;
  const float length = shortest / std::sqrt(axis_x * axis_x + axis_y * axis_y);
  result.step_x = axis_x * length;
  result.step_y = axis_y * length;
  return result;
}

Texture::Texture(const cv::Mat& luminance) {
  if (luminance.type() != CV_32FC1 || !isPowerOfTwo(luminance.cols) ||
      !isPowerOfTwo(luminance.rows)) {
    throw InputError("texture: found an image of " + std::to_string(luminance.cols) + " x " +
                     std::to_string(luminance.rows) + " and type " +
                     std::to_string(luminance.type()) +
                     "; allowed: float, one channel, sides that are powers of two");
  }
  cv::Mat image = cv::max(cv::min(luminance, 1.0), 0.0);
  levels_.push_back(quantized(image, image.cols, image.rows));
  while (image.cols > 1 || image.rows > 1) {
    image = halved(image);
    levels_.push_back(quantized(image, width(), height()));
  }
}

Texture::Level Texture::quantized(const cv::Mat& luminance, int width, int height) {
  Level level;
  level.width = luminance.cols;
  level.height = luminance.rows;
  level.scale_x = static_cast<float>(luminance.cols) / static_cast<float>(width);
  level.scale_y = static_cast<float>(luminance.rows) / static_cast<float>(height);
  level.texels.resize(luminance.total());
  std::uint16_t* texel = level.texels.data();
  for (int y = 0; y < luminance.rows; ++y) {
    const float* const row = luminance.ptr<float>(y);
    for (int x = 0; x < level.width; ++x) {
      *texel++ = static_cast<std::uint16_t>(row[x] * 65535.0F + 0.5F);
    }
  }
  return level;
}

double Texture::mean(int level) const {
  double sum = 0.0;
  for (const std::uint16_t texel : levels_[level].texels) sum += texel;
  return sum / (65535.0 * static_cast<double>(levels_[level].texels.size()));
}

}  // namespace vins::simulation
