#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace vins::camera_model {

/// A flat chessboard, by its inner corners.
struct Chessboard {
  int columns = 8;      ///< inner corners in a row
  int rows = 12;        ///< rows of inner corners
  double square = 1.0;  ///< edge of a square, in whatever unit the poses shall have

  /// Throws InputError naming the value that describes no board.
  void validate() const;

  /// Inner corners in the board's frame (z = 0), row by row.
  std::vector<Eigen::Vector3d> points() const;
};

/// Inner corners of the board in an 8-bit gray image, row by row [px], or nothing where it is not
/// seen whole. OpenCV's sector-based detector looks first (A. Duda, U. Frese, "Accurate detection
/// and localization of checkerboard corners for calibration", BMVC 2018), its classic one where
/// that finds none; both are refined to where the gradients around a corner meet.
std::optional<std::vector<Eigen::Vector2d>> detectChessboard(const cv::Mat& gray,
                                                             const Chessboard& board);

}  // namespace vins::camera_model
