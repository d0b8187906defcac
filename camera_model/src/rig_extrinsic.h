#pragma once

#include <optional>

#include "camera_model/rig.h"
#include "rig_sources.h"

namespace vins::camera_model {

/// estimate_extrinsic, or OpenVINS's calib_cam_extrinsics.
ExtrinsicMode readExtrinsicMode(const Parameters& main);

/// Pose of a camera in the body frame, as the file gives it; nothing where it has none. For a
/// camera that is given by its pose to the one before, `T_bc_before` is that one's. Throws
/// InputError for a matrix that is no pose; but with ExtrinsicMode::kUnknown what stands in the
/// file is a first guess at best: it is not judged, and what is unusable counts as nothing.
std::optional<Pose> readCameraPose(const RigSources& sources, std::size_t camera,
                                   const Pose& T_bc_before, ExtrinsicMode mode);

}  // namespace vins::camera_model
