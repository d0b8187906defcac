#include "support_files.h"

#include <filesystem>
#include <vector>

#include <ros/package.h>

#include "vins_core/input_error.h"

namespace fs = std::filesystem;

namespace vins::pipeline {

std::string findSupportFiles() {
  // PREFIX/lib/vins_pipeline/run_bag has PREFIX/share/pose_graph.
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  const fs::path prefix = self.parent_path().parent_path().parent_path();
  std::vector<fs::path> folders = {prefix / "share/pose_graph/support_files"};
  if (fs::is_directory(folders.front(), error)) return folders.front().string();
  const std::string package = ros::package::getPath("pose_graph");
  if (!package.empty()) folders.push_back(fs::path(package) / "support_files");
  if (fs::is_directory(folders.back(), error)) return folders.back().string();
  std::string looked_at;
  for (const fs::path& folder : folders) looked_at += " " + folder.string();
  throw InputError("vocabulary and pattern: found no folder of them; looked at" + looked_at +
                   "; allowed: loop_closure: 0, or vocabulary_file and brief_pattern_file in the "
                   "configuration");
}

}  // namespace vins::pipeline
