// Rigs in every dialect. A line "=== NAME" begins a further file beside the first.

#include "camera_model/rig.h"

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "fuzz_input.h"
#include "vins_core/parameters.h"

namespace {

const char* const kNames[] = {"cam0.yaml", "cam1.yaml", "imu.yaml", "kalibr_imu_chain.yaml",
                              "kalibr_imucam_chain.yaml"};

void writeFiles(const vins::fuzz::FuzzFolder& folder, const std::string& text) {
  for (const char* name : kNames) folder.remove(name);
  std::istringstream in(text);
  std::string name = "rig.yaml", content, line;
  const auto write = [&] {
    bool is_known = name == "rig.yaml";
    for (const char* known : kNames) is_known = is_known || name == known;
    if (is_known) folder.write(name, content);
  };
  while (std::getline(in, line)) {
    if (line.compare(0, 4, "=== ") != 0) {
      content += line + "\n";
      continue;
    }
    write();
    name = line.substr(4);
    content.clear();
  }
  write();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const vins::fuzz::FuzzFolder folder;
  writeFiles(folder, vins::fuzz::textOf(data, size));
  vins::fuzz::expectResultOrInputError([&] {
    const auto parameters = vins::Parameters::load(folder.path("rig.yaml"));
    const auto rig = vins::camera_model::readRig(parameters);
    vins::camera_model::configurationWarnings(parameters, rig);
    vins::camera_model::requireImageTopic(parameters, rig);
    vins::camera_model::requireImuTopic(parameters, rig);
    // What could be read can be written and read again.
    vins::camera_model::readRig(vins::Parameters::parse(vins::camera_model::toYaml(rig), "again"));
  });
  return 0;
}
