#include "simulation/texture.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "simulation/texture_painting.h"
#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

const std::vector<TextureStyle> kStyles = {
    TextureStyle::kPlaster, TextureStyle::kBricks, TextureStyle::kTiles,  TextureStyle::kPrint,
    TextureStyle::kClutter, TextureStyle::kBoards, TextureStyle::kGround, TextureStyle::kClouds};

Texture painted(std::uint64_t seed, const std::string& stream,
                TextureStyle style = TextureStyle::kClutter) {
  TextureOptions options;
  options.width = 512;
  options.height = 256;
  options.style = style;
  return makeNaturalTexture(seed, stream, options);
}

/// Mean squared difference of places `lag` texels apart.
double structureFunction(const Texture& texture, int lag) {
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < texture.height(); y += 2) {
    for (int x = 0; x < texture.width(); x += 2) {
      const auto px = static_cast<float>(x) + 0.5F, py = static_cast<float>(y) + 0.5F;
      const double here = texture.sample(px, py, 0.0F);
      const double right = texture.sample(px + static_cast<float>(lag), py, 0.0F) - here;
      const double below = texture.sample(px, py + static_cast<float>(lag), 0.0F) - here;
      sum += right * right + below * below;
      count += 2;
    }
  }
  return sum / count;
}

TEST(Texture, MipLevelsHaveEqualMeans) {
  for (const TextureStyle style : kStyles) {
    const Texture texture = painted(1, "mips", style);
    ASSERT_EQ(texture.levels(), 10);
    for (int level = 1; level < texture.levels(); ++level) {
      // Each of up to 9 levels rounds to 1 / 65535.
      EXPECT_NEAR(texture.mean(level), texture.mean(0), 1e-5) << "level " << level;
    }
  }
}

TEST(Texture, MipLevelsAreNotShifted) {
  // A cosine along x and y: each level damps it and must not move it.
  const int side = 256;
  cv::Mat waves(side, side, CV_32FC1);
  const double k = 2.0 * M_PI * 4 / side;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double wave = std::cos(k * (x + 0.5)) + std::sin(k * (y + 0.5));
      waves.at<float>(y, x) = static_cast<float>(0.5 + 0.2 * wave);
    }
  }
  const Texture texture(waves);
  for (const float level : {0.0F, 0.5F, 1.0F, 1.7F, 2.0F, 3.0F, 3.4F}) {
    double cos_x = 0.0, sin_x = 0.0, cos_y = 0.0, sin_y = 0.0;
    for (double y = 0.25; y < side; y += 0.5) {
      for (double x = 0.25; x < side; x += 0.5) {
        const double value = texture.sample(static_cast<float>(x), static_cast<float>(y), level);
        cos_x += value * std::cos(k * x), sin_x += value * std::sin(k * x);
        cos_y += value * std::cos(k * y), sin_y += value * std::sin(k * y);
      }
    }
    // The phase as a shift in texels of level 0; the texels' 16 bits average out.
    EXPECT_NEAR(std::atan2(sin_x, cos_x) / k, 0.0, 1e-3) << "level " << level;
    EXPECT_NEAR(std::atan2(cos_y, sin_y) / k, 0.0, 1e-3) << "level " << level;
    EXPECT_GT(cos_x, 0.0);
  }
}

TEST(Texture, SamplesTexelsAtTheirCentresAndLinearlyBetween) {
  const cv::Mat_<float> values =
      (cv::Mat_<float>(2, 4) << 0.1F, 0.3F, 0.2F, 0.9F, 0.5F, 0.4F, 0.8F, 0.0F);
  const Texture texture(values);
  const double rounding = 1.0 / 65535.0;
  EXPECT_NEAR(texture.sample(1.5F, 0.5F, 0.0F), 0.3, rounding);
  EXPECT_NEAR(texture.sample(2.0F, 0.5F, 0.0F), 0.25, rounding);
  EXPECT_NEAR(texture.sample(2.0F, 1.0F, -1.0F), 0.5 * (0.25 + 0.6), rounding);
  EXPECT_NEAR(texture.sample(4.0F, 0.5F, 0.0F), 0.5 * (0.9 + 0.1), rounding) << "periodic";
  EXPECT_NEAR(texture.sample(-1.5F, -0.5F, 0.0F), 0.8, rounding) << "periodic";
}

TEST(Texture, IsSmoothInTheLevel) {
  const Texture texture = painted(1, "smooth");
  for (float level = -0.5F; level < 8.0F; level += 0.01F) {
    EXPECT_NEAR(texture.sample(77.3F, 20.9F, level), texture.sample(77.3F, 20.9F, level + 0.01F),
                0.011);
  }
}

TEST(Texture, RefusesSizesThatAreNoPowersOfTwo) {
  EXPECT_THROW(Texture(cv::Mat(16, 24, CV_32FC1, cv::Scalar(0.5))), InputError);
  EXPECT_THROW(Texture(cv::Mat(16, 16, CV_8UC1, cv::Scalar(5))), InputError);
  TextureOptions options;
  options.width = 100;
  EXPECT_THROW(makeNaturalTexture(1, "bad", options), InputError);
}

TEST(Footprint, OfASquarePixelIsOneTap) {
  const Footprint f = FootprintFilter().footprint(4.0F, 0.0F, 0.0F, 4.0F);
  EXPECT_EQ(f.side_taps, 0);
  EXPECT_FLOAT_EQ(f.centre_weight, 1.0F);
  // Four texels are two levels, and half a level against aliasing.
  EXPECT_NEAR(f.level, 2.5, 1e-5);
}

TEST(Footprint, OfALongPixelTapsAlongItsLongAxis) {
  const Footprint f = FootprintFilter().footprint(6.0F, 6.0F, -2.0F, 2.0F);
  ASSERT_GT(f.side_taps, 0);
  EXPECT_NEAR(f.step_x, f.step_y, 1e-4);
  EXPECT_NEAR(std::hypot(f.step_x, f.step_y), 2.0 * std::sqrt(2.0), 1e-3);
  float sum = f.centre_weight;
  for (int i = 0; i < f.side_taps; ++i) sum += 2.0F * f.weights[i];
  EXPECT_NEAR(sum, 1.0, 1e-5);
}

TEST(Footprint, ChangesContinuously) {
  const FootprintFilter filter;
  for (float stretch = 1.0F; stretch < 6.0F; stretch += 0.01F) {
    const Footprint a = filter.footprint(2.0F * stretch, 0.3F, 0.1F, 2.0F);
    const Footprint b = filter.footprint(2.0F * (stretch + 0.01F), 0.3F, 0.1F, 2.0F);
    EXPECT_NEAR(a.level, b.level, 0.02);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a.weights[i], b.weights[i], 0.01);
  }
}

TEST(NaturalTexture, IsTheSameForTheSameSeedAndStreamOnly) {
  const auto difference = [](const Texture& a, const Texture& b) {
    double sum = 0.0;
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 512; ++x) {
        const auto px = static_cast<float>(x) + 0.5F, py = static_cast<float>(y) + 0.5F;
        sum += std::abs(a.sample(px, py, 0.0F) - b.sample(px, py, 0.0F));
      }
    }
    return sum / (256 * 512);
  };
  const Texture texture = painted(5, "wall");
  EXPECT_EQ(difference(texture, painted(5, "wall")), 0.0);
  EXPECT_GT(difference(texture, painted(6, "wall")), 0.05);
  EXPECT_GT(difference(texture, painted(5, "floor")), 0.05);
}

TEST(NaturalTexture, IsTileable) {
  for (const TextureStyle style : kStyles) {
    const Texture texture = painted(3, "tile", style);
    double at_seam = 0.0, inside = 0.0;
    for (int y = 0; y < texture.height(); ++y) {
      const float py = static_cast<float>(y) + 0.5F;
      const float last = texture.sample(511.5F, py, 0.0F), first = texture.sample(0.5F, py, 0.0F);
      at_seam += std::abs(first - last);
      for (int x = 100; x < 400; x += 10) {
        const float px = static_cast<float>(x) + 0.5F;
        inside += std::abs(texture.sample(px + 1.0F, py, 0.0F) - texture.sample(px, py, 0.0F)) / 30;
      }
    }
    // Without wrapping the seam's step would be as large as the texture's contrast: 5 to 10 times
    // that of neighbours.
    EXPECT_LT(at_seam, 2.5 * inside) << "style " << static_cast<int>(style);
  }
}

TEST(NaturalTexture, HasTheSpectrumOfNaturalImages) {
  // An amplitude spectrum of 1 / f means a structure function that grows as slowly as log(lag);
  // white noise would have a constant one, a smooth ramp one growing as lag^2.
  for (const TextureStyle style : kStyles) {
    const Texture texture = painted(4, "spectrum", style);
    const double near = structureFunction(texture, 1), far = structureFunction(texture, 16);
    const double slope = std::log(far / near) / std::log(16.0);
    EXPECT_GT(slope, 0.1) << "style " << static_cast<int>(style);
    EXPECT_LT(slope, 1.2) << "style " << static_cast<int>(style);
  }
}

TEST(FractalNoise, HasEqualPowerPerOctave) {
  Random random(1, "noise");
  const cv::Mat noise = fractalNoise(random, 512, 512);
  // Variance of the means over blocks falls by one octave's share with each doubling of the block.
  std::vector<double> variances;
  for (int block = 1; block <= 32; block *= 2) {
    double sum = 0.0, squares = 0.0;
    const int blocks = 512 / block;
    for (int i = 0; i < blocks * blocks; ++i) {
      const cv::Rect cell(i % blocks * block, i / blocks * block, block, block);
      const double mean = cv::mean(noise(cell))[0];
      sum += mean, squares += mean * mean;
    }
    variances.push_back(squares / (blocks * blocks) - std::pow(sum / (blocks * blocks), 2));
  }
  EXPECT_NEAR(variances[0], 1.0, 1e-3);
  for (std::size_t i = 1; i + 1 < variances.size(); ++i) {
    // Seven octaves share the power.
    EXPECT_NEAR(variances[i] - variances[i + 1], 1.0 / 8.0, 0.06) << "octave " << i;
  }
}

}  // namespace
}  // namespace vins::simulation
