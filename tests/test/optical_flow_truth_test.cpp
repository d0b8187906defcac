// The simulator's images against its geometry, through the eyes of a KLT tracker.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/video.hpp>

#include "simulated_views.h"
#include "simulation/image_simulator.h"

namespace vins::simulation {
namespace {

using Eigen::Vector2d;

constexpr double kFramePeriod = 0.05;

struct FlowErrors {
  int tracks = 0;
  double median_px = 0.0;  ///< of the length of the errors
  Vector2d bias_px;        ///< medians of the errors' coordinates
};

double medianOf(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

Vector2d toEigen(const cv::Point2f& p) { return {p.x, p.y}; }

/// Where the second image shows what the first one shows at a pixel, by geometry alone.
std::optional<Vector2d> predictedPixel(const ImageSimulator& simulator, const Vector2d& pixel,
                                       double t_s, double next_t_s) {
  const double row_s = simulator.timeOfRow(t_s, pixel.y());
  const auto p_w = simulator.pointAt(roomTrajectory(row_s), pixel, row_s);
  if (!p_w) return std::nullopt;
  // The row at which the second image shows the point decides about the pose: a fixed point.
  double row = pixel.y();
  std::optional<Vector2d> next;
  for (int i = 0; i < 10; ++i) {
    const double next_row_s = simulator.timeOfRow(next_t_s, row);
    const Pose T_wb = roomTrajectory(next_row_s);
    if (!simulator.isVisible(T_wb, *p_w, next_row_s)) return std::nullopt;
    next = simulator.project(T_wb, *p_w);
    row = next->y();
  }
  return next;
}

/// Errors of KLT tracks between pairs of images a frame period apart, all along the trajectory.
FlowErrors measureFlow(const ImageSimulator& simulator) {
  std::vector<double> lengths, x_errors, y_errors;
  const cv::TermCriteria precise(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 60, 1e-3);
  for (double t_s = 0.5; t_s < 12.0; t_s += 2.3) {
    const cv::Mat first = simulator.render(roomTrajectory, t_s, 0);
    const cv::Mat second = simulator.render(roomTrajectory, t_s + kFramePeriod, 1);
    std::vector<cv::Point2f> corners, tracked;
    cv::goodFeaturesToTrack(first, corners, 300, 0.01, 15);
    std::vector<std::uint8_t> status;
    std::vector<float> residuals;
    cv::calcOpticalFlowPyrLK(first, second, corners, tracked, status, residuals, {21, 21}, 3,
                             precise);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector2d pixel = toEigen(corners[i]);
      if (!status[i] || !simulator.camera().contains(pixel, 20.0)) continue;
      const auto expected = predictedPixel(simulator, pixel, t_s, t_s + kFramePeriod);
      if (!expected || !simulator.camera().contains(*expected, 20.0)) continue;
      const Vector2d error = toEigen(tracked[i]) - *expected;
      lengths.push_back(error.norm());
      x_errors.push_back(error.x());
      y_errors.push_back(error.y());
    }
  }
  return {static_cast<int>(lengths.size()),
          medianOf(lengths),
          {medianOf(x_errors), medianOf(y_errors)}};
}

FlowErrors measureFlow(const std::shared_ptr<const camera_model::Camera>& camera,
                       const ImageOptions& options) {
  const FlowErrors errors =
      measureFlow(ImageSimulator(sharedRoom(), camera, forwardCamera(), options, 1, "cam0"));
  std::cout << camera->name() << ": " << errors.tracks << " tracks, median error "
            << errors.median_px << " px, bias " << errors.bias_px.transpose() << " px\n";
  return errors;
}

TEST(OpticalFlow, OfNoiseFreeImagesMatchesGeometry) {
  for (const auto& camera : vins::camera_model::testing::exampleCameras()) {
    const FlowErrors errors = measureFlow(camera, noiseFree());
    EXPECT_GT(errors.tracks, 300) << camera->name();
    EXPECT_LT(errors.median_px, 0.10) << camera->name();
    EXPECT_LT(errors.bias_px.norm(), 0.02) << camera->name();
  }
}

TEST(OpticalFlow, OfNoisyImagesMatchesGeometry) {
  for (const auto& camera : vins::camera_model::testing::exampleCameras()) {
    const FlowErrors errors = measureFlow(camera, ImageOptions());
    EXPECT_GT(errors.tracks, 300) << camera->name();
    EXPECT_LT(errors.median_px, 0.15) << camera->name();
    EXPECT_LT(errors.bias_px.norm(), 0.02) << camera->name();
  }
}

TEST(OpticalFlow, OfARollingShutterMatchesGeometryRowByRow) {
  ImageOptions options;
  options.rolling_shutter_readout_s = 0.03;
  for (const auto& camera : vins::camera_model::testing::exampleCameras()) {
    const FlowErrors errors = measureFlow(camera, options);
    EXPECT_LT(errors.median_px, 0.15) << camera->name();
    EXPECT_LT(errors.bias_px.norm(), 0.02) << camera->name();
  }
}

/// Mean grey value of 7 x 7 pixels about a place.
double patchMean(const cv::Mat& image, const Vector2d& pixel) {
  cv::Mat patch;
  cv::getRectSubPix(image, {7, 7}, cv::Point2f(pixel.cast<float>().x(), pixel.cast<float>().y()),
                    patch, CV_32F);
  return cv::mean(patch)[0];
}

TEST(OpticalFlow, SurfacesDoNotShimmer) {
  // Slowly, by about half a pixel per image, past all phases of the pixel grid and across mip
  // levels.
  const auto slowly = [](double t_s) { return roomTrajectory(2.0 + 0.03 * t_s); };
  const auto camera = vins::camera_model::testing::exampleCameras().front();
  ImageOptions options = noiseFree();
  options.gain = 1.0;
  const ImageSimulator simulator(sharedRoom(), camera, forwardCamera(), options, 1, "cam0");
  std::vector<cv::Mat> images;
  for (int i = 0; i < 24; ++i) images.push_back(simulator.render(slowly, i * kFramePeriod, i));
  std::vector<double> deviations;
  for (double v = 40.0; v < 440.0; v += 16.0) {
    for (double u = 40.0; u < 712.0; u += 16.0) {
      const auto p_w = simulator.pointAt(slowly(0.0), {u, v}, 0.0);
      double sum = 0.0, squares = 0.0;
      bool seen = true;
      for (int i = 0; i < 24 && seen; ++i) {
        const Pose T_wb = slowly(i * kFramePeriod);
        seen = simulator.isVisible(T_wb, *p_w, 0.0);
        if (!seen) break;
        const double grey = patchMean(images[i], *simulator.project(T_wb, *p_w));
        sum += grey, squares += grey * grey;
      }
      if (seen) deviations.push_back(std::sqrt(std::max(0.0, squares / 24 - sum * sum / 576)));
    }
  }
  ASSERT_GT(deviations.size(), 500U);
  const double median = medianOf(deviations);
  std::sort(deviations.begin(), deviations.end());
  const double worst = deviations[deviations.size() * 95 / 100];
  std::cout << "patch brightness over time: median deviation " << median << ", 95 % below " << worst
            << " grey values\n";
  // Patches at depth edges change by parallax, and the patch stays square while surfaces turn.
  EXPECT_LT(median, 0.3);
  EXPECT_LT(worst, 1.5);
}

}  // namespace
}  // namespace vins::simulation
