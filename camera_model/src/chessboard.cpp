#include "camera_model/chessboard.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "vins_core/input_error.h"

namespace vins {
namespace {

using Corners = std::vector<cv::Point2f>;

bool detectBySectors(const cv::Mat& gray, cv::Size size, Corners* corners) {
  const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY;
  return cv::findChessboardCornersSB(gray, size, *corners, flags);
}

/// Shortest distance of two corners that are neighbours in a row [px].
double shortestStep(const Corners& corners, int columns) {
  double shortest = 1e9;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (i % columns != 0) shortest = std::min(shortest, cv::norm(corners[i] - corners[i - 1]));
  }
  return shortest;
}

bool detectByQuads(const cv::Mat& gray, cv::Size size, Corners* corners) {
  const int flags =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FILTER_QUADS;
  if (!cv::findChessboardCorners(gray, size, *corners, flags)) return false;
  // A window that reaches the next corner would be drawn to it.
  const int half = std::clamp(static_cast<int>(0.4 * shortestStep(*corners, size.width)), 2, 11);
  const cv::TermCriteria until(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 50, 1e-3);
  cv::cornerSubPix(gray, *corners, {half, half}, {-1, -1}, until);
  return true;
}

}  // namespace

void Chessboard::validate() const {
  if (columns < 3 || rows < 3) {
    throw InputError("chessboard: found " + std::to_string(columns) + " x " + std::to_string(rows) +
                     " inner corners; allowed: at least 3 x 3");
  }
  if (!(square > 0.0) || !std::isfinite(square)) {
    throw InputError("chessboard: found a square of " + std::to_string(square) +
                     "; allowed: a number above 0");
  }
}

std::vector<Eigen::Vector3d> Chessboard::points() const {
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      points.emplace_back(column * square, row * square, 0.0);
    }
  }
  return points;
}

std::optional<std::vector<Eigen::Vector2d>> detectChessboard(const cv::Mat& gray,
                                                             const Chessboard& board) {
  const cv::Size size(board.columns, board.rows);
  Corners corners;
  if (!detectBySectors(gray, size, &corners) && !detectByQuads(gray, size, &corners)) {
    return std::nullopt;
  }
  std::vector<Eigen::Vector2d> pixels;
  for (const cv::Point2f& corner : corners) pixels.emplace_back(corner.x, corner.y);
  return pixels;
}

}  // namespace vins
