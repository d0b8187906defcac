#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vins_core/parameters.h"

namespace vins::camera_model {

/// The documents and sections that a rig is read from.
struct RigSources {
  Parameters main;                ///< the file that the user named
  Parameters chain;               ///< where sections cam0, cam1, ... stand; `main` without such
  std::optional<Parameters> imu;  ///< where the IMU's noise stands: a section imu0, or a file's top
  std::vector<Parameters> files;  ///< that were read beside `main`
  /// Kalibr's or OpenVINS's form, or a camera alone: what is missing is unknown, not forgotten.
  bool is_incomplete_by_form = false;

  /// The section of a camera in the chain, or nothing.
  std::optional<Parameters> chainSection(std::size_t camera) const;
};

/// Finds the files and sections of a rig: those that relative_config_imu and relative_config_imucam
/// name, and Kalibr's imu.yaml beside a camchain. Throws InputError where a file that is named
/// cannot be read.
RigSources findRigSources(const Parameters& main);

/// The file that `key` names, seen from the folder of `parameters`. Throws InputError naming the
/// key where it is not there.
std::string fileOf(const Parameters& parameters, const std::string& key,
                   const std::string& what_it_is);

}  // namespace vins::camera_model
