#include "pose_graph/place/spread_corners.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "vins_core/input_error.h"
#include "vins_core/option_check.h"

namespace vins::pose_graph {
namespace {

constexpr int kCornersPerCell = 10;

/// Where corners may be: white, but for discs about what is taken.
cv::Mat1b freePlaces(const cv::Size& size, const std::vector<cv::Point2f>& taken, double radius) {
  cv::Mat1b free(size, 255);
  for (const cv::Point2f& pixel : taken) {
    cv::circle(free, {cvRound(pixel.x), cvRound(pixel.y)}, cvRound(radius), 0, cv::FILLED);
  }
  return free;
}

bool isStronger(const cv::KeyPoint& a, const cv::KeyPoint& b) {
  return std::tuple(-a.response, a.pt.y, a.pt.x) < std::tuple(-b.response, b.pt.y, b.pt.x);
}

}  // namespace

void SpreadCornersOptions::validate() const {
  requireWithin("spread corners", "max_corners", max_corners, {0, 5000});
  requireWithin("spread corners", "fast_threshold", fast_threshold, {1, 255});
  requireWithin("spread corners", "min_distance", min_distance, {0, 100});
  requireWithin("spread corners", "border", border, {0, 1000});
}

std::vector<cv::Point2f> findSpreadCorners(const cv::Mat& image,
                                           const std::vector<cv::Point2f>& taken,
                                           const SpreadCornersOptions& options) {
  if (image.type() != CV_8UC1) throw InputError("spread corners: the image is not CV_8UC1");
  const cv::Rect inside(options.border, options.border, image.cols - 2 * options.border,
                        image.rows - 2 * options.border);
  if (inside.width <= 0 || inside.height <= 0 || options.max_corners == 0) return {};
  const double cell_area =
      inside.area() * std::min(1.0, 1.0 * kCornersPerCell / options.max_corners);
  const int columns = std::max<int>(1, std::lround(inside.width / std::sqrt(cell_area)));
  const int rows = std::max<int>(1, std::lround(inside.height / std::sqrt(cell_area)));
  const std::size_t per_cell = std::max(1, options.max_corners / (columns * rows));

  std::vector<cv::KeyPoint> corners;
  cv::FAST(image, corners, options.fast_threshold, true);
  const cv::Mat1b free = freePlaces(image.size(), taken, options.min_distance);
  std::vector<std::vector<cv::KeyPoint>> cells(static_cast<std::size_t>(columns) * rows);
  for (const cv::KeyPoint& corner : corners) {
    const cv::Point pixel(corner.pt);
    if (!inside.contains(pixel) || free(pixel) == 0) continue;
    const int column = (pixel.x - inside.x) * columns / inside.width;
    const int row = (pixel.y - inside.y) * rows / inside.height;
    cells[static_cast<std::size_t>(row) * columns + column].push_back(corner);
  }
  std::vector<cv::Point2f> found;
  for (auto& cell : cells) {
    std::sort(cell.begin(), cell.end(), isStronger);
    for (std::size_t i = 0; i < std::min(per_cell, cell.size()); ++i) found.push_back(cell[i].pt);
  }
  return found;
}

}  // namespace vins::pose_graph
