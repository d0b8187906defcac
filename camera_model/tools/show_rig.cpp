// What the reader of rigs makes of a configuration file of VINS-Mono, VINS-Fusion, Kalibr or
// OpenVINS: printed, or written, as a configuration file of our own form.

#include <iostream>
#include <string>

#include <boost/program_options.hpp>

#include "camera_model/rig.h"
#include "vins_core/run_tool.h"
#include "vins_core/text_file.h"

namespace po = boost::program_options;

namespace {

vins::ToolExit showRig(const po::variables_map& values) {
  const auto parameters = vins::Parameters::load(values["file"].as<std::string>());
  const vins::camera_model::Rig rig = vins::camera_model::readRig(parameters);
  for (const auto& warning : vins::camera_model::configurationWarnings(parameters, rig)) {
    std::cerr << "warning: " << warning << "\n";
  }
  if (rig.imu.unit == vins::camera_model::ImuNoiseUnit::kSample) {
    std::cerr << "note: the IMU's noise was taken for deviations of one sample at " << rig.imu.rate
              << " Hz, as VINS-Mono has them; below it is given as densities\n";
  }
  const std::string text = vins::camera_model::toYaml(rig);
  if (values.count("write") == 0) {
    std::cout << text;
  } else {
    const std::string path = values["write"].as<std::string>();
    vins::writeTextFile(path, text);
    std::cout << path << ": written, " << rig.cameras.size() << " camera(s)\n";
  }
  return vins::ToolExit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  vins::ToolDescription tool;
  tool.name = "show_rig";
  tool.about =
      "Usage: show_rig FILE [--write OUT]\n\n"
      "Reads a rig's file of VINS-Mono, VINS-Fusion, Kalibr (camchain-imucam) or OpenVINS, or a\n"
      "camera's file, and prints what was understood, as a configuration file of our own form.\n"
      "What was mended, assumed or not used is told on standard error.\n";
  po::options_description options;
  options.add_options()("file", po::value<std::string>()->required(), "the rig's file")(
      "write", po::value<std::string>(), "write the configuration to this file");
  tool.options.add(options);
  tool.positional = {{"file", 1}};
  return vins::runTool(argc, argv, tool, showRig);
}
