#pragma once

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>

#include "vins_pipeline/pipeline.h"

namespace vins::pipeline {

/// The maps of a run: the one it began with, and the one it leaves.
struct RunMaps {
  std::optional<pose_graph::LoadedMap> loaded;
  bool is_joined = false;    ///< this run and the loaded map have one frame
  std::string file_to_save;  ///< "" for none
  std::size_t saved_keyframes = 0;
  std::string error;  ///< why the map could not be saved; "" where it could
};

/// At the end of a run, after PoseGraph::finish(): notes what became of the loaded map, and saves
/// the map. An error is kept, not thrown: the run's other results shall be written all the same.
void finishMaps(Pipeline* pipeline, RunMaps* maps);

/// A line for the loaded and one for the saved map, where there are such.
std::ostream& operator<<(std::ostream& out, const RunMaps& maps);

}  // namespace vins::pipeline
