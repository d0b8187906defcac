#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace vins::simulation {

/// What one pixel sees of a texture: an ellipse, as the mip level of its short axis and a few taps
/// along its long axis with weights that fall off like a Gaussian. Level and weights are continuous
/// functions of the ellipse, so that nothing pops while the camera moves.
struct Footprint {
  float level = 0.0F;            ///< mip level, not rounded
  float step_x = 0.0F;           ///< from tap to tap [texels of level 0]
  float step_y = 0.0F;           ///< from tap to tap [texels of level 0]
  int side_taps = 0;             ///< taps on each side of the centre
  float centre_weight = 1.0F;    ///< the weights of all taps sum to one
  float weights[3] = {0, 0, 0};  ///< of the pairs of side taps, from the centre outwards
};

/// Footprints of pixels. After "Feline: fast elliptical lines for anisotropic texture mapping"
/// (McCormack et al., SIGGRAPH 1999), with fewer taps.
class FootprintFilter {
 public:
  FootprintFilter();

  /// The footprint of a pixel whose right and lower neighbours lie (x_u, y_u) and (x_v, y_v) texels
  /// of level 0 away.
  Footprint footprint(float x_u, float y_u, float x_v, float y_v) const;

 private:
  static constexpr int kEntries = 256;
  std::vector<Footprint> by_elongation_;  ///< weights only; for long / short axis from 1 to 4
};

/// A tileable luminance image in [0, 1] with its mip chain. Texel (i, j) of level 0 covers
/// [i, i + 1) x [j, j + 1): its centre lies at (i + 0.5, j + 0.5), and level l's texels are 2^l
/// wide over the same coordinates, so that no level is shifted against another. Each level is the
/// one below, filtered by [1 3 3 1] / 8 along both axes; all have the same mean.
class Texture {
 public:
  /// From a CV_32FC1 image, clamped to [0, 1]. Both sides must be powers of two; throws InputError.
  explicit Texture(const cv::Mat& luminance);

  int width() const { return levels_.front().width; }
  int height() const { return levels_.front().height; }
  int levels() const { return static_cast<int>(levels_.size()); }

  /// Mean luminance of a level.
  double mean(int level) const;

  /// Luminance at a place [texels of level 0], periodic: bilinear within the two levels about
  /// `level`, linear between them. Levels outside of the chain are taken to its ends.
  float sample(float x, float y, float level) const;

  /// Luminance seen through a pixel's footprint about a place.
  float sample(float x, float y, const Footprint& footprint) const;

 private:
  struct Level {
    int width = 0;
    int height = 0;
    float scale_x = 1.0F;               ///< texels of this level per texel of level 0
    float scale_y = 1.0F;               ///< texels of this level per texel of level 0
    std::vector<std::uint16_t> texels;  ///< 65535 is luminance 1
  };
  static Level quantized(const cv::Mat& luminance, int width, int height);
  static float bilinear(const Level& level, float x, float y);

  std::vector<Level> levels_;
};

namespace texture_detail {

/// std::floor() is a library call without SSE 4.1.
inline int floorOf(float x) {
  const int truncated = static_cast<int>(x);
  return truncated - (x < static_cast<float>(truncated) ? 1 : 0);
}

}  // namespace texture_detail

inline float Texture::bilinear(const Level& level, float x, float y) {
  x = x * level.scale_x - 0.5F;
  y = y * level.scale_y - 0.5F;
  const int column = texture_detail::floorOf(x);
  const int row = texture_detail::floorOf(y);
  const float share_x = x - static_cast<float>(column);
  const float share_y = y - static_cast<float>(row);
  const int left = column & (level.width - 1);
  const int right = (column + 1) & (level.width - 1);
  const std::uint16_t* const upper = level.texels.data() + (row & (level.height - 1)) * level.width;
  const std::uint16_t* const lower =
      level.texels.data() + ((row + 1) & (level.height - 1)) * level.width;
  const float a = static_cast<float>(upper[left]), b = static_cast<float>(upper[right]);
  const float c = static_cast<float>(lower[left]), d = static_cast<float>(lower[right]);
  const float top = a + share_x * (b - a);
  const float bottom = c + share_x * (d - c);
  return top + share_y * (bottom - top);
}

inline float Texture::sample(float x, float y, float level) const {
  const float top = static_cast<float>(levels_.size() - 1);
  level = std::min(std::max(level, 0.0F), top);
  const int fine = static_cast<int>(level);
  const float share = level - static_cast<float>(fine);
  float value = bilinear(levels_[fine], x, y);
  if (share > 0.0F) value += share * (bilinear(levels_[fine + 1], x, y) - value);
  return value * (1.0F / 65535.0F);
}

inline float Texture::sample(float x, float y, const Footprint& f) const {
  float sum = f.centre_weight * sample(x, y, f.level);
  for (int i = 0; i < f.side_taps; ++i) {
    const float step_x = static_cast<float>(i + 1) * f.step_x;
    const float step_y = static_cast<float>(i + 1) * f.step_y;
    sum += f.weights[i] *
           (sample(x + step_x, y + step_y, f.level) + sample(x - step_x, y - step_y, f.level));
  }
  return sum;
}

}  // namespace vins::simulation
