#include "camera_model/calibration_drawing.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include <opencv2/imgproc.hpp>

#include "calibration_quality.h"

namespace vins::camera_model {
namespace {

const cv::Scalar kPaper(250, 250, 250);
const cv::Scalar kInk(40, 40, 40);
const cv::Scalar kLeftOut(40, 40, 220);
constexpr int kCaption = 36;  ///< height of the line of text below a picture [px]

/// Colours that keep apart, a view each.
cv::Scalar colourOf(std::size_t view, std::size_t count) {
  const auto hue = static_cast<uchar>(180 * view / std::max<std::size_t>(count, 1));
  cv::Mat colour(1, 1, CV_8UC3, cv::Scalar(hue, 200, 190));
  cv::cvtColor(colour, colour, cv::COLOR_HSV2BGR);
  const auto& c = colour.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

/// Pixel centres are whole numbers; drawing with a shift keeps their fractions.
cv::Point fine(const Eigen::Vector2d& pixel) {
  return {cvRound(pixel.x() * 16.0), cvRound(pixel.y() * 16.0)};
}

void drawDot(cv::Mat* picture, const Eigen::Vector2d& pixel, const cv::Scalar& colour) {
  cv::circle(*picture, fine(pixel), 16 * 5 / 2, colour, cv::FILLED, cv::LINE_AA, 4);
}

void drawCross(cv::Mat* picture, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d a(4.0, 4.0), b(4.0, -4.0);
  cv::line(*picture, fine(pixel - a), fine(pixel + a), kLeftOut, 1, cv::LINE_AA, 4);
  cv::line(*picture, fine(pixel - b), fine(pixel + b), kLeftOut, 1, cv::LINE_AA, 4);
}

void write(cv::Mat* picture, const std::string& text, cv::Point at) {
  cv::putText(*picture, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.5, kInk, 1, cv::LINE_AA);
}

/// Calls visit(upper left, lower right, corners in it) for each cell of the coverage count.
template <typename Visit>
void forEachCell(ImageSize size, const std::vector<int>& cells, Visit visit) {
  for (int row = 0; row < kCoverageRows; ++row) {
    for (int column = 0; column < kCoverageColumns; ++column) {
      const cv::Point from(size.width * column / kCoverageColumns,
                           size.height * row / kCoverageRows);
      const cv::Point to(size.width * (column + 1) / kCoverageColumns - 1,
                         size.height * (row + 1) / kCoverageRows - 1);
      visit(from, to, cells[static_cast<std::size_t>(row * kCoverageColumns + column)]);
    }
  }
}

void shadeCells(cv::Mat* picture, ImageSize size, const std::vector<int>& cells) {
  forEachCell(size, cells, [&](cv::Point from, cv::Point to, int count) {
    const double shade = 245.0 - std::min(count, 40);
    const cv::Scalar colour =
        count == 0 ? cv::Scalar(215, 215, 255) : cv::Scalar(shade, 250, shade);
    cv::rectangle(*picture, from, to, colour, cv::FILLED);
    cv::rectangle(*picture, from, to, cv::Scalar(225, 225, 225));
  });
}

/// Over the dots, on paper of their own.
void writeCounts(cv::Mat* picture, ImageSize size, const std::vector<int>& cells) {
  forEachCell(size, cells, [&](cv::Point from, cv::Point /*to*/, int count) {
    const std::string text = std::to_string(count);
    const int width = 4 + 10 * static_cast<int>(text.size());
    cv::rectangle(*picture, from + cv::Point(2, 2), from + cv::Point(width, 18), kPaper,
                  cv::FILLED);
    write(picture, text, from + cv::Point(3, 15));
  });
}

cv::Mat drawArrows(ImageSize size, const std::vector<CalibrationView>& views,
                   const Calibration& calibration, double magnification) {
  cv::Mat picture(size.height, size.width, CV_8UC3, kPaper);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewFit& fit = calibration.views[i];
    const cv::Scalar colour = colourOf(i, views.size());
    for (std::size_t j = 0; j < fit.residuals.size(); ++j) {
      if (!fit.residuals[j].allFinite()) continue;
      const Eigen::Vector2d& corner = views[i].corners[j];
      cv::line(picture, fine(corner), fine(corner + magnification * fit.residuals[j]),
               fit.inliers[j] ? colour : kLeftOut, 1, cv::LINE_AA, 4);
      cv::circle(picture, fine(corner), 16, kInk, cv::FILLED, cv::LINE_AA, 4);
    }
  }
  return picture;
}

cv::Mat drawCloud(int side, const std::vector<CalibrationView>& views,
                  const Calibration& calibration) {
  cv::Mat picture(side, side, CV_8UC3, kPaper);
  const Eigen::Vector2d center(0.5 * side, 0.5 * side);
  const double scale = 0.45 * side / (3.5 * calibration.rms);
  cv::line(picture, {side / 2, 0}, {side / 2, side}, cv::Scalar(215, 215, 215));
  cv::line(picture, {0, side / 2}, {side, side / 2}, cv::Scalar(215, 215, 215));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewFit& fit = calibration.views[i];
    for (std::size_t j = 0; j < fit.residuals.size(); ++j) {
      const Eigen::Vector2d at = center + scale * fit.residuals[j];
      if (!at.allFinite() || at.minCoeff() < 0.0 || at.maxCoeff() > side) continue;
      if (fit.inliers[j]) {
        cv::circle(picture, fine(at), 16 * 3 / 2, colourOf(i, views.size()), cv::FILLED,
                   cv::LINE_AA, 4);
      } else {
        drawCross(&picture, at);
      }
    }
  }
  for (int ring = 1; ring <= 3; ++ring) {
    const int radius = cvRound(16.0 * ring * scale * calibration.rms);
    cv::circle(picture, fine(center), radius, cv::Scalar(120, 120, 120), 1, cv::LINE_AA, 4);
  }
  return picture;
}

cv::Mat withCaption(const cv::Mat& picture, const std::string& text) {
  cv::Mat whole(picture.rows + kCaption, picture.cols, CV_8UC3, kPaper);
  picture.copyTo(whole.rowRange(0, picture.rows));
  write(&whole, text, {8, picture.rows + 23});
  return whole;
}

}  // namespace

cv::Mat drawCoverage(ImageSize size, const std::vector<CalibrationView>& views,
                     const Calibration& calibration) {
  cv::Mat picture(size.height, size.width, CV_8UC3, kPaper);
  const std::vector<int> cells = cornersPerCell(size, views, calibration);
  shadeCells(&picture, size, cells);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewFit& fit = calibration.views[i];
    for (std::size_t j = 0; j < views[i].corners.size(); ++j) {
      if (fit.used && fit.inliers[j]) {
        drawDot(&picture, views[i].corners[j], colourOf(i, views.size()));
      } else {
        drawCross(&picture, views[i].corners[j]);
      }
    }
  }
  writeCounts(&picture, size, cells);
  const auto empty = std::count(cells.begin(), cells.end(), 0);
  return withCaption(picture, std::to_string(calibration.corners_used) + " corners in use, " +
                                  std::to_string(empty) + " of " + std::to_string(cells.size()) +
                                  " cells without one; crosses: left out");
}

cv::Mat drawResiduals(ImageSize size, const std::vector<CalibrationView>& views,
                      const Calibration& calibration) {
  const double magnification = size.width / 40.0 / calibration.rms;
  cv::Mat both;
  cv::hconcat(drawArrows(size, views, calibration, magnification),
              drawCloud(size.height, views, calibration), both);
  char text[200];
  std::snprintf(text, sizeof(text),
                "rms %.3f px; left: residuals x %.0f; right: circles of 1, 2, 3 rms; red: left out",
                calibration.rms, magnification);
  return withCaption(both, text);
}

}  // namespace vins::camera_model
