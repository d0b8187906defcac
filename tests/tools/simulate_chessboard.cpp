// Renders images of a chessboard through a known camera, for trying a calibration.

#include <cstdio>
#include <filesystem>
#include <string>

#include <boost/program_options.hpp>
#include <opencv2/imgcodecs.hpp>

#include "camera_model/camera_file.h"
#include "simulation/chessboard_images.h"
#include "vins_core/input_error.h"
#include "vins_core/progress_bar.h"
#include "vins_core/run_tool.h"

namespace fs = std::filesystem;
namespace po = boost::program_options;

namespace {

po::options_description describeOptions() {
  po::options_description options;
  auto add = options.add_options();
  add("camera", po::value<std::string>()->required(), "camera file to render through");
  add("output,o", po::value<std::string>()->required(), "folder for the images; made if missing");
  add("count,n", po::value<int>()->default_value(30), "number of images");
  add("seed", po::value<std::uint64_t>()->default_value(1), "same seed, same images");
  add("width,w", po::value<int>()->default_value(9), "inner corners in a row of the board");
  add("height,h", po::value<int>()->default_value(7), "rows of inner corners");
  add("size,s", po::value<double>()->default_value(40.0), "edge of a square");
  add("noise", po::value<double>()->default_value(2.0), "deviation of the noise [gray levels]");
  return options;
}

vins::ToolExit renderAll(const po::variables_map& values) {
  const auto camera = vins::camera_model::readCameraFile(values["camera"].as<std::string>());
  const vins::camera_model::Chessboard board{values["width"].as<int>(), values["height"].as<int>(),
                                             values["size"].as<double>()};
  board.validate();
  vins::simulation::ChessboardImageOptions options;
  options.noise = values["noise"].as<double>();
  const fs::path folder = values["output"].as<std::string>();
  fs::create_directories(folder);
  const int count = values["count"].as<int>();
  auto bar = vins::ProgressBar::onStandardError("rendering", static_cast<std::size_t>(count));
  vins::simulation::Random random(values["seed"].as<std::uint64_t>(), "chessboard");
  for (int i = 0; i < count; ++i) {
    char name[32];
    std::snprintf(name, sizeof(name), "board_%03d.png", i);
    const vins::Pose T_cb = vins::simulation::randomBoardPose(*camera, board, &random);
    const cv::Mat image =
        vins::simulation::renderChessboard(*camera, board, T_cb, options, &random);
    if (!cv::imwrite((folder / name).string(), image)) {
      throw vins::InputError((folder / name).string() + ": cannot be written");
    }
    bar.update(static_cast<std::size_t>(i + 1));
  }
  bar.finish();
  return vins::ToolExit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{"simulate_chessboard",
                                   "Renders images of a chessboard through a known camera.\n"
                                   "Usage: simulate_chessboard --camera FILE -o FOLDER\n",
                                   describeOptions()};
  return vins::runTool(argc, argv, tool, renderAll);
}
