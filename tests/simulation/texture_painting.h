#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "simulation/random.h"
#include "simulation/texture.h"

namespace vins::simulation {

/// What a surface looks like.
enum class TextureStyle {
  kPlaster,  ///< walls: mottled paint with stains, scratches and a few stuck-on things
  kBricks,   ///< courses of bricks of different greys
  kTiles,    ///< a floor of square tiles, worn and with things lying about
  kPrint,    ///< posters, labels, screens: shapes and lines of writing
  kClutter,  ///< overlapping shapes of all sizes
  kBoards,   ///< planks with grain
  kGround,   ///< gravel and patches
  kClouds,   ///< soft, without edges
  kPaint,    ///< a plain painted wall: mottled by a percent
  kLacquer,  ///< furniture without structure
  kFabric,   ///< bedding and clothes: soft wrinkles
  kCurtain,  ///< soft vertical folds
  kWood      ///< a floor of boards with a faint grain
};

struct TextureOptions {
  int width = 512;            ///< texels, a power of two
  int height = 512;           ///< texels, a power of two
  double texels_per_m = 256;  ///< sets the size of bricks, letters and stains
  TextureStyle style = TextureStyle::kClutter;
  double luminance = 0.0;  ///< mean of the plain styles (kPaint to kWood); not positive: drawn
};

/// A tileable picture with the statistics of natural ones: shapes that occlude each other with
/// sizes distributed as r^-3 (A. Lee, D. Mumford, J. Huang, "Occlusion models for natural images",
/// IJCV 2001), and noise with equal power in each octave; both give an amplitude spectrum of about
/// 1 / f. Pictures of other seeds or streams have nothing in common. Throws InputError where the
/// size is not a power of two.
Texture makeNaturalTexture(std::uint64_t seed, const std::string& stream,
                           const TextureOptions& options);

/// Tileable noise of mean 0 and standard deviation 1 with equal power per octave, as CV_32FC1.
/// Octaves finer than `finest` texels are left out.
cv::Mat fractalNoise(Random& random, int width, int height, int finest = 1);

}  // namespace vins::simulation
