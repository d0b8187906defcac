#include "track_picture.h"

#include <opencv2/imgcodecs.hpp>

#include "feature_tracker/track_drawing.h"
#include "vins_core/input_error.h"

namespace vins::pipeline {

void TrackPicture::add(const PipelineResult& result, const camera_model::Camera& camera) {
  if (!from_ || isDrawn() || result.stamp < *from_ || !result.frame) return;
  picture_ = feature_tracker::drawTracks(result.image, *result.frame, camera);
}

void TrackPicture::write(const std::string& path) const {
  if (isDrawn() && !cv::imwrite(path, picture_)) throw InputError(path + ": cannot be written");
}

}  // namespace vins::pipeline
