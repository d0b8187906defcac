#pragma once

#include <string>
#include <vector>

#include "vins_core/imu.h"
#include "vins_core/time.h"
#include "vins_core/trajectory.h"

namespace vins::pipeline {

/// An image of a recording that has not been read yet.
struct ImageFile {
  Stamp stamp = 0;   ///< [ns]
  std::string path;  ///< of a file that exists
};

/// A recording in the ASL layout, in which EuRoC is distributed: what it holds, images as paths.
struct AslRecording {
  std::string folder;                           ///< the one that holds cam0 and imu0
  std::vector<std::vector<ImageFile>> cameras;  ///< of cam0 and, where it is there, cam1
  std::vector<std::string> missing_images;      ///< listed, but not there
  std::vector<ImuSample> imu;
  Trajectory ground_truth;          ///< empty where there is none
  std::string ground_truth_source;  ///< "state_groundtruth_estimate0", "vicon0" or "leica0"
};

/// What to do about images that are listed but not there.
enum class MissingImages { kRefuse, kSkip };

/// Reads a recording. `path` is the folder with cam0 and imu0 in it (EuRoC's mav0), the one above
/// it, or the one above that if there is only one recording in it. Ground truth is taken from
/// state_groundtruth_estimate0, else vicon0, else leica0, whose poses have no rotation (identity)
/// and are those of the prism. Throws InputError with file and line for what is missing or
/// malformed, stamps that do not rise, and (unless skipped) missing images.
AslRecording readAslFolder(const std::string& path, MissingImages missing = MissingImages::kRefuse);

/// Reads the samples of an imu0/data.csv: stamp [ns], angular velocity [rad/s], specific force
/// [m/s^2]. Throws InputError with file and line.
std::vector<ImuSample> readImuCsv(const std::string& path);

}  // namespace vins::pipeline
