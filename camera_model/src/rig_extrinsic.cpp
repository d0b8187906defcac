#include "rig_extrinsic.h"

#include <cmath>
#include <iomanip>
#include <sstream>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kTyped = 0.05 * kDegree;  ///< numbers typed with few digits are off by as much
constexpr double kMost = 3.0 * kDegree;    ///< beyond, it is no measured rotation
const char* const kAllowed =
    "a rotation: orthonormal rows, determinant 1; up to 3 degrees off are mended";

/// By how much a matrix stretches, as an angle [rad]: 0 for a rotation.
double distanceFromRotation(const Eigen::Matrix3d& R) {
  const Eigen::Vector3d stretches = Eigen::JacobiSVD<Eigen::Matrix3d>(R).singularValues();
  return (stretches.array() - 1.0).abs().maxCoeff();
}

bool isNearRotation(const Eigen::Matrix3d& R) {
  return distanceFromRotation(R) <= kMost && R.determinant() > 0.0;
}

/// Fails for what is no rotation; says so where it is only near to one.
void judgeRotation(const Parameters& parameters, const std::string& key, const Eigen::Matrix3d& R) {
  std::ostringstream text;
  if (!isNearRotation(R)) {
    text << "a matrix that is no rotation (determinant " << R.determinant() << ")";
    parameters.fail(key, text.str(), kAllowed);
  }
  const double off = distanceFromRotation(R);
  if (off <= kTyped) return;
  text << "key '" << key << "' is " << std::setprecision(2) << off / kDegree
       << " degrees off a rotation; the nearest one is taken";
  parameters.remark(key, text.str());
}

/// Reads the poses of a rig's files.
class PoseReader {
 public:
  PoseReader(const RigSources& sources, bool judges) : sources_(sources), judges_(judges) {}

  std::optional<Pose> read(std::size_t camera, const Pose& T_bc_before) const {
    const Parameters& main = sources_.main;
    const std::string key = "body_T_cam" + std::to_string(camera);
    const bool is_first = camera == 0;
    main.know({key});
    // Known, whichever of them counts.
    if (is_first) main.know({"extrinsicRotation", "extrinsicTranslation"});
    if (main.has(key)) return readMatrix(main, key);
    if (is_first && (main.has("extrinsicRotation") || main.has("extrinsicTranslation"))) {
      return readRotationAndTranslation();
    }
    return readFromChain(camera, T_bc_before);
  }

 private:
  Pose poseOf(const Parameters& parameters, const std::string& key, Eigen::Matrix4d T) const {
    const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
    if (judges_) judgeRotation(parameters, key, R);
    if (!isNearRotation(R)) T.topLeftCorner<3, 3>().setIdentity();
    return poseFromMatrix(T);
  }

  Pose readMatrix(const Parameters& parameters, const std::string& key) const {
    return poseOf(parameters, key, parameters.matrix(key, 4, 4));
  }

  Pose readRotationAndTranslation() const {
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    T.topLeftCorner<3, 3>() = sources_.main.matrix("extrinsicRotation", 3, 3);
    T.topRightCorner<3, 1>() = sources_.main.matrix("extrinsicTranslation", 3, 1);
    return poseOf(sources_.main, "extrinsicRotation", T);
  }

  /// Kalibr's T_cam_imu takes the body's coordinates to the camera, OpenVINS's T_imu_cam the
  /// camera's to the body; T_cn_cnm1 takes those of the camera before to this one.
  std::optional<Pose> readFromChain(std::size_t camera, const Pose& T_bc_before) const {
    const std::optional<Parameters> section = sources_.chainSection(camera);
    if (!section) return std::nullopt;
    section->know({"T_cn_cnm1"});
    if (section->has("T_imu_cam")) return readMatrix(*section, "T_imu_cam");
    if (section->has("T_cam_imu")) return readMatrix(*section, "T_cam_imu").inverse();
    if (camera == 0 || !section->has("T_cn_cnm1")) return std::nullopt;
    return T_bc_before * readMatrix(*section, "T_cn_cnm1").inverse();
  }

  const RigSources& sources_;
  const bool judges_;
};

}  // namespace

ExtrinsicMode readExtrinsicMode(const Parameters& main) {
  const int fallback = main.flagOr("calib_cam_extrinsics", false) ? 1 : 0;
  switch (main.integerOr("estimate_extrinsic", fallback, {0, 2})) {
    case 0:
      return ExtrinsicMode::kTrusted;
    case 1:
      return ExtrinsicMode::kRefined;
    default:
      return ExtrinsicMode::kUnknown;
  }
}

std::optional<Pose> readCameraPose(const RigSources& sources, std::size_t camera,
                                   const Pose& T_bc_before, ExtrinsicMode mode) {
  if (mode != ExtrinsicMode::kUnknown) {
    return PoseReader(sources, true).read(camera, T_bc_before);
  }
  try {
    return PoseReader(sources, false).read(camera, T_bc_before);
  } catch (const InputError&) {
    return std::nullopt;  // a matrix of another size, or of words: nobody needs it
  }
}

}  // namespace vins::camera_model
