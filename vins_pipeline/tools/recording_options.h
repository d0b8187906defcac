#pragma once

#include <string>
#include <vector>

#include "vins_pipeline/pipeline.h"

namespace vins::pipeline {

/// Reads the options of a run over a recording as readPipelineOptions() does, and what the
/// recording (bags, or one folder) says of them: the camera where the file leaves it to
/// camera_info_topic, and a warning where the two differ. A folder in the ASL layout has both parts
/// of the IMU in one file. Throws InputError as readPipelineOptions() and readCameraInfo() do.
PipelineOptions readOptionsForRecording(const std::string& config,
                                        const std::vector<std::string>& recording,
                                        std::vector<std::string>* warnings);

}  // namespace vins::pipeline
