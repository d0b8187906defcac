#include "vins_estimator/initialization/waiting_reason.h"

namespace vins::estimator {
namespace {

const char* codeOf(StructureStatus status) {
  switch (status) {
    case StructureStatus::kFewTracks:
    case StructureStatus::kLostFrame:
      return "init_few_tracks";
    case StructureStatus::kLittleParallax:
      return "init_little_parallax";
    default:
      return "init_inconsistent";
  }
}

const char* textOf(StructureStatus status) {
  switch (status) {
    case StructureStatus::kFewTracks:
    case StructureStatus::kLostFrame:
      return "waiting: too few features are tracked from frame to frame; show the camera a "
             "textured scene, move more slowly";
    case StructureStatus::kLittleParallax:
      return "waiting: the scene shows too little parallax; move sideways, rotation does not help";
    default:
      return "waiting: the images fit no rigid scene that turns as the gyroscope says; check "
             "T_bc, td and the intrinsics, avoid moving objects";
  }
}

const char* textOf(AlignmentStatus status) {
  switch (status) {
    case AlignmentStatus::kLittleExcitation:
      return "waiting: too little acceleration to tell the scale; move with changes of speed and "
             "direction";
    case AlignmentStatus::kGyroscopeDisagrees:
      return "waiting: images and gyroscope turn differently; check T_bc, td and the intrinsics";
    case AlignmentStatus::kGravityImplausible:
      return "waiting: what remains of the acceleration is not gravity; check g_norm, T_bc and td, "
             "or move more";
    case AlignmentStatus::kImplausible:
      return "waiting: the solution has a speed or biases beyond reason; check the IMU's units";
    default:
      return "waiting: structure and IMU contradict each other; check T_bc, td and noise, or move "
             "more";
  }
}

}  // namespace

WaitingReason explainFewTracks(int features) {
  return {codeOf(StructureStatus::kFewTracks),
          textOf(StructureStatus::kFewTracks),
          {{"features", features}}};
}

WaitingReason explain(const VisualStructure& structure) {
  return {codeOf(structure.status),
          std::string(textOf(structure.status)) + " (" + toString(structure.status) + ")",
          {{"shared_features", structure.shared},
           {"parallax_px", structure.parallax},
           {"parallax_beyond_rotation_px", structure.own_parallax},
           {"visual_rms_sigma", structure.rms}}};
}

WaitingReason explain(const Alignment& alignment) {
  const bool little = alignment.status == AlignmentStatus::kLittleExcitation;
  return {little ? "init_little_excitation" : "init_inconsistent",
          std::string(textOf(alignment.status)) + " (" + toString(alignment.status) + ")",
          {{"scale_sigma_percent", 100.0 * alignment.scale_sigma},
           {"gravity_m_s2", alignment.gravity},
           {"visual_rms_sigma", alignment.visual_rms},
           {"imu_chi2_per_dof", alignment.imu_chi2}}};
}

}  // namespace vins::estimator
