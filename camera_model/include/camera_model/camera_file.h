#pragma once

#include <memory>
#include <string>

#include "camera_model/camera.h"
#include "vins_core/parameters.h"

namespace vins::camera_model {

/// Camera of a file, by its content: camodocal's and VINS-Mono's form (model_type, image_width,
/// projection_parameters, ...; also inside of a larger configuration file), or Kalibr's camchain,
/// of which `kalibr_camera` ("cam0") is taken. Throws InputError naming file, key, what was found
/// and what is allowed.
std::unique_ptr<Camera> readCameraFile(const std::string& path,
                                       const std::string& kalibr_camera = "cam0");

/// The same from parameters that have been read already.
std::unique_ptr<Camera> readCamera(const Parameters& parameters,
                                   const std::string& kalibr_camera = "cam0");

/// The camera in camodocal's and VINS-Mono's form. A k3 that is zero is left out, so that programs
/// that know four coefficients read the same camera.
std::string toCamodocalYaml(const Camera& camera);

/// The camera as Kalibr's camchain with the one section `kalibr_camera`. Throws InputError for what
/// Kalibr has no form for: the Scaramuzza model, and a k3 that is not zero.
std::string toKalibrYaml(const Camera& camera, const std::string& kalibr_camera = "cam0");

}  // namespace vins::camera_model
