#pragma once

#include <opencv2/core.hpp>

#include "camera_model/camera.h"
#include "vins_core/feature_frame.h"

namespace vins::feature_tracker {

/// How tracks are drawn.
struct TrackDrawingOptions {
  int full_age = 40;           ///< track length that gets the last colour [images]
  double trail_seconds = 0.1;  ///< tails show how the points moved in this time [s]
};

/// The image (CV_8UC1, or CV_8UC3 in BGR) with the observations that one camera (0 or 1) made of
/// it: circles from red (new) over yellow to blue (old), with a tail towards where they came from.
/// CV_8UC3.
cv::Mat drawTracks(const cv::Mat& image, const FeatureFrame& frame,
                   const camera_model::Camera& camera, int camera_index = 0,
                   const TrackDrawingOptions& options = {});

}  // namespace vins::feature_tracker
