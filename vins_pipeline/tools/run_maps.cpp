#include "run_maps.h"

#include <filesystem>

#include "vins_core/input_error.h"

namespace vins::pipeline {

void finishMaps(Pipeline* pipeline, RunMaps* maps) {
  const std::vector<pose_graph::SequencePath> paths = pipeline->poseGraph()->paths();
  maps->loaded = pipeline->loadedMap();
  maps->is_joined = !paths.empty() && paths.back().sequence >= 0 && paths.back().in_map;
  if (maps->file_to_save.empty() || paths.empty()) return;
  try {
    maps->saved_keyframes = pipeline->saveMap(maps->file_to_save);
  } catch (const InputError& error) {
    maps->error = error.what();
  }
}

std::ostream& operator<<(std::ostream& out, const RunMaps& maps) {
  if (maps.loaded) {
    out << "loaded map    " << maps.loaded->describe()
        << (maps.is_joined ? "; this run has joined it\n" : "; this run has not joined it\n");
  }
  if (maps.file_to_save.empty()) return out;
  out << "saved map     ";
  if (!maps.error.empty()) return out << "none: " << maps.error << "\n";
  if (maps.saved_keyframes == 0) return out << "none: there was no keyframe\n";
  const auto bytes = std::filesystem::file_size(maps.file_to_save);
  return out << maps.file_to_save << ": " << maps.saved_keyframes << " keyframes, "
             << 1e-6 * static_cast<double>(bytes) << " MB\n";
}

}  // namespace vins::pipeline
