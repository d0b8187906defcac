// Draws the pattern by which BRIEF compares pixels, and writes it as a YAML file.

#include <cstdint>
#include <string>

#include <boost/program_options.hpp>

#include "pose_graph/place/brief.h"
#include "vins_core/run_tool.h"
#include "vins_core/text_file.h"

namespace po = boost::program_options;

namespace {

po::options_description describeOptions() {
  po::options_description options;
  auto add = options.add_options();
  add("output,o", po::value<std::string>()->required(), "YAML file to write");
  add("seed", po::value<std::uint64_t>()->default_value(1), "same seed, same pattern");
  add("patch", po::value<int>()->default_value(49), "side of the compared square [px]");
  return options;
}

vins::ToolExit makePattern(const po::variables_map& values) {
  const auto pattern = vins::pose_graph::BriefPattern::generate(values["seed"].as<std::uint64_t>(),
                                                                values["patch"].as<int>());
  vins::writeTextFile(values["output"].as<std::string>(), pattern.toYaml());
  return vins::ToolExit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{"make_brief_pattern",
                                   "Draws the 256 pairs of pixels that BRIEF compares.\n"
                                   "Example: make_brief_pattern -o brief_pattern.yml\n",
                                   describeOptions()};
  return vins::runTool(argc, argv, tool, makePattern);
}
