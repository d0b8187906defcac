#include "vins_pipeline/asl_folder.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "csv_file.h"
#include "vins_core/input_error.h"
#include "vins_core/trajectory_file.h"

namespace fs = std::filesystem;

namespace vins::pipeline {
namespace {

bool holdsRecording(const fs::path& folder) {
  return fs::is_directory(folder / "cam0") || fs::is_directory(folder / "imu0");
}

/// Folders one and two levels below that hold a recording.
std::vector<fs::path> recordingsBelow(const fs::path& folder) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (!entry.is_directory()) continue;
    if (holdsRecording(entry.path())) found.push_back(entry.path());
    if (holdsRecording(entry.path() / "mav0")) found.push_back(entry.path() / "mav0");
  }
  std::sort(found.begin(), found.end());
  return found;
}

fs::path findRecording(const fs::path& path) {
  if (!fs::is_directory(path)) {
    throw InputError(path.string() + ": is no folder; allowed: a folder in the ASL layout");
  }
  if (holdsRecording(path)) return path;
  if (holdsRecording(path / "mav0")) return path / "mav0";
  const std::vector<fs::path> found = recordingsBelow(path);
  if (found.empty()) {
    throw InputError(path.string() +
                     ": found no recording; allowed: a folder with cam0 and imu0 in it or in its "
                     "mav0");
  }
  if (found.size() > 1) {
    throw InputError(path.string() + ": found " + std::to_string(found.size()) +
                     " recordings, such as " + found[0].string() + " and " + found[1].string() +
                     "; allowed: one");
  }
  return found.front();
}

/// Appends the images of a camera to the recording.
void readCameraFolder(const fs::path& camera, MissingImages missing, AslRecording* recording) {
  std::vector<ImageFile> images;
  readCsvFile((camera / "data.csv").string(), 1, [&](const CsvRow& row) {
    const fs::path path = camera / "data" / row.fields[0];
    std::error_code error;  // also where the name is none that the file system takes
    if (!row.fields[0].empty() && fs::is_regular_file(path, error)) {
      images.push_back({row.stamp, path.string()});
    } else if (missing == MissingImages::kSkip) {
      recording->missing_images.push_back(path.string());
    } else {
      throw InputError("image file '" + path.string() + "' is missing");
    }
  });
  recording->cameras.push_back(std::move(images));
}

Trajectory readLeica(const std::string& path) {
  Trajectory trajectory;
  readCsvFile(path, 3, [&](const CsvRow& row) {
    const Eigen::Vector3d position(row.number(0), row.number(1), row.number(2));
    trajectory.append({row.stamp, Pose(Eigen::Quaterniond::Identity(), position)});
  });
  return trajectory;
}

void readGroundTruth(const fs::path& folder, AslRecording* recording) {
  for (const std::string source : {"state_groundtruth_estimate0", "vicon0", "leica0"}) {
    const fs::path path = folder / source / "data.csv";
    if (!fs::exists(path)) continue;
    recording->ground_truth_source = source;
    recording->ground_truth =
        source == "leica0" ? readLeica(path.string()) : readTrajectoryFile(path.string());
    return;
  }
}

}  // namespace

AslRecording readAslFolder(const std::string& path, MissingImages missing) {
  const fs::path folder = findRecording(path);
  AslRecording recording;
  recording.folder = folder.string();
  readCameraFolder(folder / "cam0", missing, &recording);
  if (fs::is_directory(folder / "cam1")) readCameraFolder(folder / "cam1", missing, &recording);
  recording.imu = readImuCsv((folder / "imu0" / "data.csv").string());
  readGroundTruth(folder, &recording);
  return recording;
}

std::vector<ImuSample> readImuCsv(const std::string& path) {
  std::vector<ImuSample> samples;
  readCsvFile(path, 6, [&](const CsvRow& row) {
    ImuSample sample;
    sample.stamp = row.stamp;
    sample.angular_velocity = {row.number(0), row.number(1), row.number(2)};
    sample.acceleration = {row.number(3), row.number(4), row.number(5)};
    samples.push_back(sample);
  });
  return samples;
}

}  // namespace vins::pipeline
