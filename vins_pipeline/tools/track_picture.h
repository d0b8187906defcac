#pragma once

#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "camera_model/camera.h"
#include "vins_core/time.h"
#include "vins_pipeline/pipeline.h"

namespace vins::pipeline {

/// One picture of a run: the first image from a time on, with its tracks (drawTracks()).
class TrackPicture {
 public:
  /// No picture is wanted.
  TrackPicture() = default;
  /// `from`: the image's stamp, at least [ns].
  explicit TrackPicture(Stamp from) : from_(from) {}

  void add(const PipelineResult& result, const camera_model::Camera& camera);

  bool isDrawn() const { return !picture_.empty(); }

  /// Does nothing where none is drawn. Throws InputError where the file cannot be written.
  void write(const std::string& path) const;

 private:
  std::optional<Stamp> from_;
  cv::Mat picture_;
};

}  // namespace vins::pipeline
