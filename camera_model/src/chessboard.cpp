#include "camera_model/chessboard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

using Corners = std::vector<cv::Point2f>;

constexpr double kWindowShare = 0.3;    ///< of the distance to the next corner
constexpr int kMaxHalfWindow = 5;       ///< of the refinement [px]
constexpr double kMaxRefinement = 1.5;  ///< a corner that wanders further stays where it was [px]

bool detectBySectors(const cv::Mat& gray, cv::Size size, Corners* corners) {
  const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY;
  return cv::findChessboardCornersSB(gray, size, *corners, flags);
}

bool detectByQuads(const cv::Mat& gray, cv::Size size, Corners* corners) {
  const int flags =
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FILTER_QUADS;
  return cv::findChessboardCorners(gray, size, *corners, flags);
}

/// Shortest distance of a corner to its neighbours in row and column [px].
double shortestStep(const Corners& corners, int columns) {
  const int count = static_cast<int>(corners.size());
  double shortest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < count; ++i) {
    if ((i + 1) % columns != 0)
      shortest = std::min(shortest, cv::norm(corners[i + 1] - corners[i]));
    if (i + columns < count)
      shortest = std::min(shortest, cv::norm(corners[i + columns] - corners[i]));
  }
  return shortest;
}

/// Moves each corner to where the gradients around it meet. The sectors' own corners are off by a
/// tenth of a pixel where the squares' edges are bent by the lens.
void refine(const cv::Mat& gray, int columns, Corners* corners) {
  // A window that reaches the next corner would be drawn to it.
  const double step = shortestStep(*corners, columns);
  const int half = std::clamp(static_cast<int>(kWindowShare * step), 2, kMaxHalfWindow);
  const cv::TermCriteria until(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-4);
  Corners refined = *corners;
  cv::cornerSubPix(gray, refined, {half, half}, {-1, -1}, until);
  for (std::size_t i = 0; i < refined.size(); ++i) {
    if (cv::norm(refined[i] - (*corners)[i]) < kMaxRefinement) (*corners)[i] = refined[i];
  }
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
  refine(gray, board.columns, &corners);
  std::vector<Eigen::Vector2d> pixels;
  for (const cv::Point2f& corner : corners) pixels.emplace_back(corner.x, corner.y);
  return pixels;
}

}  // namespace vins::camera_model
