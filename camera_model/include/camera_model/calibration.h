#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "camera_model/camera.h"
#include "camera_model/chessboard.h"
#include "vins_core/pose.h"

namespace vins::camera_model {

/// How a camera is calibrated.
struct CalibrationOptions {
  CameraModel model = CameraModel::kPinhole;
  std::string camera_name = "camera";
  ImageSize image_size;
  Chessboard board;
  bool estimate_k3 = true;        ///< pinhole only; without it k3 is zero
  bool reject_outliers = true;    ///< leave out corners and views that disagree with the rest
  double outlier_deviations = 5;  ///< corners further off than this many robust deviations

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

std::ostream& operator<<(std::ostream& out, const CalibrationOptions& options);

/// One image of the board.
struct CalibrationView {
  std::string name;                      ///< of the image, for reports
  std::vector<Eigen::Vector2d> corners;  ///< detected, in the order of Chessboard::points() [px]
};

/// What came out for one view.
struct ViewFit {
  bool used = false;                       ///< false: no pose was found, or too many outliers
  Pose T_cb;                               ///< board in the camera frame, in the unit of the square
  std::vector<Eigen::Vector2d> residuals;  ///< projected minus detected, a corner each [px]
  std::vector<bool> inliers;               ///< corners that the last adjustment used
  double rms = 0.0;                        ///< over the inliers: sqrt(mean |residual|^2) [px]
};

/// A calibrated camera and what speaks for it.
struct Calibration {
  std::shared_ptr<const Camera> camera;
  /// Of the parameters, for corners as noisy as the residuals are; zero rows where one was held.
  /// Empty where the views do not determine all parameters.
  Eigen::MatrixXd covariance;
  std::vector<ViewFit> views;  ///< in the order of the views given
  int corners_used = 0;
  int corners_left_out = 0;           ///< of views in use
  double rms = 0.0;                   ///< over all corners in use: sqrt(mean |residual|^2) [px]
  double rms_with_outliers = 0.0;     ///< over all corners of the views in use [px]
  std::vector<std::string> warnings;  ///< why not to trust it, for people
};

/// Calibrates from views of a chessboard: the start is the best of several focal lengths with the
/// board's poses found linearly from bearings (so that wide cameras work); then all parameters and
/// poses are adjusted with a robust loss, corners that disagree are left out, and the rest is
/// adjusted by plain least squares. Throws InputError where no adjustment is possible: fewer than
/// three views, a view with another number of corners, corners outside of the image, or views that
/// no camera of the model explains.
Calibration calibrate(const CalibrationOptions& options, const std::vector<CalibrationView>& views);

}  // namespace vins::camera_model
