// Calibrates a camera from images of a chessboard. Options as in camodocal and VINS-Mono.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <future>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <boost/program_options.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "camera_model/calibration.h"
#include "camera_model/calibration_drawing.h"
#include "camera_model/camera_file.h"
#include "vins_core/input_error.h"
#include "vins_core/progress_bar.h"
#include "vins_core/run_tool.h"
#include "vins_core/text_file.h"

namespace fs = std::filesystem;
namespace po = boost::program_options;

namespace {

struct Arguments {
  vins::camera_model::CalibrationOptions calibration;
  std::string input;
  std::string prefix;
  std::string extension;
  std::string output;
  bool view_results = false;
  bool write_kalibr = false;
  bool verbose = false;
};

po::options_description describeOptions() {
  po::options_description options;
  auto add = options.add_options();
  add("width,w", po::value<int>()->default_value(8), "inner corners in a row of the board");
  add("height,h", po::value<int>()->default_value(12), "rows of inner corners");
  add("size,s", po::value<double>()->default_value(7.0), "edge of a square, in any unit");
  add("input,i", po::value<std::string>()->default_value("calibrationdata"),
      "folder of the images");
  add("prefix,p", po::value<std::string>()->default_value(""), "take images whose names begin so");
  add("file-extension,e", po::value<std::string>()->default_value(".png"),
      "take images whose names end so");
  add("camera-model", po::value<std::string>()->default_value("mei"),
      "pinhole, kannala-brandt, mei, scaramuzza, double-sphere or eucm");
  add("camera-name", po::value<std::string>()->default_value("camera"),
      "name of the camera, and of the files written");
  add("output,o", po::value<std::string>()->default_value("."),
      "folder for the results; made where it is missing");
  add("no-k3", po::bool_switch(), "pinhole: hold k3 at zero, for who reads four coefficients");
  add("kalibr", po::bool_switch(), "also write the camera as Kalibr's camchain, without k3");
  add("keep-outliers", po::bool_switch(), "use every corner, also those that disagree");
  add("view-results", po::bool_switch(), "also write each image with its corners drawn");
  add("opencv", po::value<bool>()->default_value(true)->implicit_value(true),
      "accepted for compatibility; corners are always found by OpenCV");
  add("verbose,v", po::value<bool>()->default_value(false)->implicit_value(true),
      "name each image while looking for the board");
  return options;
}

Arguments readArguments(const po::variables_map& values) {
  Arguments arguments;
  arguments.calibration.board = {values["width"].as<int>(), values["height"].as<int>(),
                                 values["size"].as<double>()};
  arguments.calibration.model =
      vins::camera_model::cameraModelFromString(values["camera-model"].as<std::string>());
  arguments.calibration.camera_name = values["camera-name"].as<std::string>();
  arguments.calibration.estimate_k3 = !values["no-k3"].as<bool>();
  arguments.calibration.reject_outliers = !values["keep-outliers"].as<bool>();
  arguments.input = values["input"].as<std::string>();
  arguments.prefix = values["prefix"].as<std::string>();
  arguments.extension = values["file-extension"].as<std::string>();
  arguments.output = values["output"].as<std::string>();
  arguments.view_results = values["view-results"].as<bool>();
  arguments.write_kalibr = values["kalibr"].as<bool>();
  arguments.verbose = values["verbose"].as<bool>();
  if (arguments.write_kalibr) {
    arguments.calibration.estimate_k3 = false;
    if (arguments.calibration.model == vins::camera_model::CameraModel::kScaramuzza) {
      throw vins::InputError("--kalibr: found the model scaramuzza, for which Kalibr has no form");
    }
  }
  arguments.calibration.board.validate();
  return arguments;
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::vector<fs::path> listImages(const Arguments& arguments) {
  if (!fs::is_directory(arguments.input)) {
    throw vins::InputError(arguments.input + ": is no folder; allowed: a folder of images (-i)");
  }
  std::vector<fs::path> paths;
  for (const fs::directory_entry& entry : fs::directory_iterator(arguments.input)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(arguments.prefix, 0) == 0 && endsWith(name, arguments.extension)) {
      paths.push_back(entry.path());
    }
  }
  if (paths.empty()) {
    throw vins::InputError(arguments.input + ": no image '" + arguments.prefix + "*" +
                           arguments.extension + "' in it; see --prefix and -e");
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// An image of the input folder and what was found in it.
struct Detection {
  fs::path path;
  vins::camera_model::ImageSize size;  ///< zero where the file is no image
  std::optional<std::vector<Eigen::Vector2d>> corners;
};

Detection detect(const fs::path& path, const vins::camera_model::Chessboard& board) {
  Detection detection;
  detection.path = path;
  const cv::Mat gray = cv::imread(path.string(), cv::IMREAD_GRAYSCALE);
  if (gray.empty()) return detection;
  detection.size = {gray.cols, gray.rows};
  detection.corners = detectChessboard(gray, board);
  return detection;
}

/// Two images at a time, so that two cores are busy.
std::vector<Detection> detectAll(const std::vector<fs::path>& paths, const Arguments& arguments) {
  std::vector<Detection> detections;
  auto bar = vins::ProgressBar::onStandardError("looking for the board", paths.size());
  for (std::size_t i = 0; i < paths.size(); i += 2) {
    std::future<Detection> second;
    if (i + 1 < paths.size()) {
      second = std::async(std::launch::async, detect, paths[i + 1], arguments.calibration.board);
    }
    detections.push_back(detect(paths[i], arguments.calibration.board));
    if (second.valid()) detections.push_back(second.get());
    bar.update(detections.size(), arguments.verbose ? paths[i].filename().string() : "");
  }
  bar.finish();
  return detections;
}

std::vector<vins::camera_model::CalibrationView> toViews(const std::vector<Detection>& detections,
                                                         vins::camera_model::ImageSize* size) {
  std::vector<vins::camera_model::CalibrationView> views;
  for (const Detection& detection : detections) {
    const std::string name = detection.path.filename().string();
    if (detection.size.width == 0) {
      std::cerr << name << ": cannot be read as an image, left out\n";
      continue;
    }
    if (size->width == 0) *size = detection.size;
    if (detection.size != *size) {
      std::ostringstream message;
      message << detection.path.string() << ": found " << detection.size.width << " x "
              << detection.size.height << " pixels; allowed: " << size->width << " x "
              << size->height << ", as the images before it";
      throw vins::InputError(message.str());
    }
    if (!detection.corners) {
      std::cerr << name << ": the whole board is not seen, left out\n";
      continue;
    }
    views.push_back({name, *detection.corners});
  }
  return views;
}

std::string describeViews(const std::vector<vins::camera_model::CalibrationView>& views,
                          const vins::camera_model::Calibration& calibration) {
  std::ostringstream text;
  text << "image                          rms [px]   corners left out\n";
  for (std::size_t i = 0; i < views.size(); ++i) {
    const vins::camera_model::ViewFit& fit = calibration.views[i];
    char line[160];
    if (fit.used) {
      std::snprintf(
          line, sizeof(line), "%-30s %8.4f   %zu\n", views[i].name.c_str(), fit.rms,
          static_cast<std::size_t>(std::count(fit.inliers.begin(), fit.inliers.end(), false)));
    } else {
      std::snprintf(line, sizeof(line), "%-30s     left out: disagrees with the others\n",
                    views[i].name.c_str());
    }
    text << line;
  }
  return text.str();
}

std::string describeResult(const vins::camera_model::Calibration& calibration) {
  std::ostringstream text;
  char line[160];
  const auto names = calibration.camera->parameterNames();
  const auto values = calibration.camera->parameters();
  text << "parameter            value       deviation\n";
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    std::snprintf(
        line, sizeof(line), "%-10s %16.9g   %13.3g\n", names[i].c_str(), values[k],
        calibration.covariance.size() > 0 ? std::sqrt(calibration.covariance(k, k)) : NAN);
    text << line;
  }
  std::snprintf(
      line, sizeof(line),
      "reprojection error: %.4f px rms over %d corners (%d left out; %.4f px with them)\n",
      calibration.rms, calibration.corners_used, calibration.corners_left_out,
      calibration.rms_with_outliers);
  text << line;
  for (const std::string& warning : calibration.warnings) text << "warning: " << warning << "\n";
  if (calibration.warnings.empty()) text << "coverage and conditioning are good\n";
  return text.str();
}

void writeImage(const fs::path& path, const cv::Mat& image) {
  if (!cv::imwrite(path.string(), image)) {
    throw vins::InputError(path.string() + ": cannot be written");
  }
}

void writeViews(const Arguments& arguments,
                const std::vector<vins::camera_model::CalibrationView>& views) {
  for (const vins::camera_model::CalibrationView& view : views) {
    cv::Mat image = cv::imread((fs::path(arguments.input) / view.name).string());
    std::vector<cv::Point2f> corners;
    for (const Eigen::Vector2d& corner : view.corners) {
      corners.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    }
    const vins::camera_model::Chessboard& board = arguments.calibration.board;
    cv::drawChessboardCorners(image, {board.columns, board.rows}, corners, true);
    writeImage(fs::path(arguments.output) / ("corners_" + view.name), image);
  }
}

void writeResults(const Arguments& arguments,
                  const std::vector<vins::camera_model::CalibrationView>& views,
                  const vins::camera_model::Calibration& calibration, const std::string& report) {
  const fs::path folder = arguments.output;
  const std::string name = arguments.calibration.camera_name;
  const fs::path yaml = folder / (name + "_camera_calib.yaml");
  vins::writeTextFile(yaml.string(), vins::camera_model::toCamodocalYaml(*calibration.camera));
  vins::writeTextFile((folder / (name + "_report.txt")).string(), report);
  if (arguments.write_kalibr) {
    vins::writeTextFile((folder / (name + "_camchain.yaml")).string(),
                        vins::camera_model::toKalibrYaml(*calibration.camera));
  }
  const vins::camera_model::ImageSize size = arguments.calibration.image_size;
  writeImage(folder / (name + "_coverage.png"),
             vins::camera_model::drawCoverage(size, views, calibration));
  writeImage(folder / (name + "_residuals.png"),
             vins::camera_model::drawResiduals(size, views, calibration));
  std::cout << "written: " << yaml.string() << ", and " << name << "_report.txt, " << name
            << "_coverage.png, " << name << "_residuals.png beside it\n";
}

vins::ToolExit calibrate(const po::variables_map& values) {
  Arguments arguments = readArguments(values);
  fs::create_directories(arguments.output);
  const std::vector<fs::path> paths = listImages(arguments);
  const auto views = toViews(detectAll(paths, arguments), &arguments.calibration.image_size);
  std::cerr << "board found in " << views.size() << " of " << paths.size() << " images\n";
  if (arguments.view_results) writeViews(arguments, views);
  if (views.empty()) {
    throw vins::InputError(arguments.input + ": no image shows a whole board of " +
                           std::to_string(arguments.calibration.board.columns) + " x " +
                           std::to_string(arguments.calibration.board.rows) +
                           " inner corners; see -w and -h");
  }
  const vins::camera_model::Calibration calibration =
      vins::camera_model::calibrate(arguments.calibration, views);
  std::ostringstream report;
  report << arguments.calibration << "\n"
         << describeViews(views, calibration) << "\n"
         << describeResult(calibration);
  std::cout << report.str();
  writeResults(arguments, views, calibration, report.str());
  return vins::ToolExit::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const vins::ToolDescription tool{
      "intrinsic_calibration",
      "Calibrates a camera from images of a chessboard.\n"
      "Usage: intrinsic_calibration -w 9 -h 6 -s 25 -i FOLDER --prefix left -e .jpg "
      "--camera-model pinhole\n",
      describeOptions()};
  return vins::runTool(argc, argv, tool, calibrate);
}
