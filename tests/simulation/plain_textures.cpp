#include "simulation/plain_textures.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vins::simulation {
namespace {

/// Wrinkles and folds have no structure finer than this [m].
constexpr double kFinestWrinkle_m = 0.025;
constexpr double kFoldWidth_m = 0.14;
constexpr double kBoardWidth_m = 0.14;
/// The grain of wood is so many times longer than wide.
constexpr int kGrainElongation = 16;

/// Fractal noise without octaves finer than `metres`.
cv::Mat noiseFrom(Random& random, const TextureOptions& options, double metres) {
  const int finest = std::max(1, static_cast<int>(metres * options.texels_per_m));
  return fractalNoise(random, options.width, options.height, finest);
}

cv::Mat modulated(double luminance, const cv::Mat& modulation) {
  return luminance * (1.0 + modulation);
}

cv::Mat paintWall(Random& random, const TextureOptions& options, double luminance,
                  double contrast) {
  return modulated(luminance, contrast * fractalNoise(random, options.width, options.height));
}

/// Soft shading, with a crease along each line where a smooth height is zero.
cv::Mat paintFabric(Random& random, const TextureOptions& options, double luminance) {
  const cv::Mat height = noiseFrom(random, options, 2.0 * kFinestWrinkle_m);
  const cv::Mat shade = noiseFrom(random, options, kFinestWrinkle_m);
  const cv::Mat weave = fractalNoise(random, options.width, options.height);
  cv::Mat crease;
  cv::exp(-8.0 * cv::abs(height), crease);
  return modulated(luminance, 0.14 * shade - 0.26 * crease + 0.02 * weave);
}

/// Vertical folds that wander a little from top to bottom.
cv::Mat paintCurtain(Random& random, const TextureOptions& options, double luminance) {
  const cv::Mat wander = noiseFrom(random, options, 0.3);
  const cv::Mat weave = fractalNoise(random, options.width, options.height);
  const double folds =
      std::max(1.0, std::round(options.width / (kFoldWidth_m * options.texels_per_m)));
  cv::Mat image(options.height, options.width, CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double phase = 2.0 * M_PI * folds * x / image.cols + 1.2 * wander.at<float>(y, x);
      const double fold = 0.16 * std::sin(phase) + 0.06 * std::sin(2.0 * phase + 1.0);
      image.at<float>(y, x) =
          static_cast<float>(luminance * (1.0 + fold + 0.012 * weave.at<float>(y, x)));
    }
  }
  return image;
}

/// Boards along x with a faint grain and darker joints.
cv::Mat paintWood(Random& random, const TextureOptions& options, double luminance) {
  const int narrow = std::max(4, options.width / kGrainElongation);
  const cv::Mat grain = fractalNoise(random, narrow, options.height);
  const int board = std::max(2, static_cast<int>(kBoardWidth_m * options.texels_per_m));
  std::vector<double> shades;
  for (int y = 0; y < options.height; y += board) shades.push_back(random.uniform(0.92, 1.08));
  cv::Mat image(options.height, options.width, CV_32FC1);
  for (int y = 0; y < image.rows; ++y) {
    const double joint = y % board == 0 ? 0.75 : 1.0;
    const double row = luminance * joint * shades[static_cast<std::size_t>(y / board)];
    for (int x = 0; x < image.cols; ++x) {
      const double place = static_cast<double>(x) * grain.cols / image.cols;
      const int left = static_cast<int>(place);
      const double share = place - left;
      const double value = (1.0 - share) * grain.at<float>(y, left) +
                           share * grain.at<float>(y, (left + 1) % grain.cols);
      image.at<float>(y, x) = static_cast<float>(row * (1.0 + 0.10 * value));
    }
  }
  return image;
}

}  // namespace

bool isPlainStyle(TextureStyle style) {
  return style == TextureStyle::kPaint || style == TextureStyle::kLacquer ||
         style == TextureStyle::kFabric || style == TextureStyle::kCurtain ||
         style == TextureStyle::kWood;
}

cv::Mat paintPlainSurface(Random& random, const TextureOptions& options) {
  const double drawn = random.uniform(0.3, 0.6);
  const double luminance = options.luminance > 0.0 ? options.luminance : drawn;
  switch (options.style) {
    case TextureStyle::kFabric:
      return paintFabric(random, options, luminance);
    case TextureStyle::kCurtain:
      return paintCurtain(random, options, luminance);
    case TextureStyle::kWood:
      return paintWood(random, options, luminance);
    case TextureStyle::kLacquer:
      return paintWall(random, options, luminance, 0.006);
    default:
      return paintWall(random, options, luminance, 0.012);
  }
}

}  // namespace vins::simulation
