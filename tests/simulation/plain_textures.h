#pragma once

#include <opencv2/core.hpp>

#include "simulation/texture_painting.h"

namespace vins::simulation {

/// Whether a style is one of paintPlainSurface().
bool isPlainStyle(TextureStyle style);

/// A tileable luminance image (CV_32FC1) of a surface in a home, of little contrast: paint,
/// lacquer, fabric, curtain or wood. Its mean is about `options.luminance`, or drawn where that is
/// not positive.
cv::Mat paintPlainSurface(Random& random, const TextureOptions& options);

}  // namespace vins::simulation
