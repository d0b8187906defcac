#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "camera_model/calibration.h"

namespace vins::camera_model {

/// The state of a calibration under way.
struct CalibrationState {
  std::unique_ptr<Camera> camera;
  std::vector<std::optional<Pose>> poses;  ///< T_cb a view; views without one are left alone
};

/// Which corners of which views take part.
using CornerMask = std::vector<std::vector<bool>>;

/// How an adjustment is done.
struct AdjustmentOptions {
  int max_iterations = 200;
  double robust_scale = 0.0;  ///< of the Cauchy loss [px]; 0: plain least squares
  bool estimate_k3 = true;
};

/// Adjusts camera and poses to the corners (Ceres, Levenberg-Marquardt, poses eliminated first).
/// False where the state projects a corner nowhere, or nothing could be improved; the state is
/// then as it was.
bool adjust(const std::vector<Eigen::Vector3d>& board_points,
            const std::vector<CalibrationView>& views, const CornerMask& mask,
            const AdjustmentOptions& options, CalibrationState* state);

/// Covariance of the camera's parameters at an adjusted state for corners of unit noise, [px^-2]
/// times the parameters' squares; parameters held constant have zeros. Nothing where the corners
/// do not determine them all.
std::optional<Eigen::MatrixXd> parameterCovariance(const std::vector<Eigen::Vector3d>& board_points,
                                                   const std::vector<CalibrationView>& views,
                                                   const CornerMask& mask, bool estimate_k3,
                                                   const CalibrationState& state);

/// Projected minus detected corners of a view [px]; infinite where the camera does not see a point.
std::vector<Eigen::Vector2d> cornerResiduals(const Camera& camera, const Pose& T_cb,
                                             const std::vector<Eigen::Vector3d>& board_points,
                                             const CalibrationView& view);

}  // namespace vins::camera_model
