#include "feature_tracker/optical_flow.h"

#include <algorithm>
#include <cmath>

#include <opencv2/video/tracking.hpp>

#include "feature_tracker/image_noise.h"

namespace vins::feature_tracker {
namespace {

// Root mean square gradient in the weakest direction below which a patch cannot be followed
// [grey values/px]: that of the image's noise, by its deviation, and never more than this.
constexpr double kFlatByNoise = 0.4;
constexpr double kFlat = 0.72;
constexpr int kWayBackLevels = 0;
constexpr float kDarkest = 8.0F;  // grey value below which a ratio says nothing

cv::TermCriteria criteriaOf(const OpticalFlowOptions& options) {
  return {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, options.iterations, options.step};
}

/// The same in the unit of cv::calcOpticalFlowPyrLK(): mean square, grey values scaled by 1 / 32.
double flatness(double noise) {
  const double gradient = std::min(kFlat, kFlatByNoise * noise);
  return gradient * gradient / (32.0 * 32.0);
}

}  // namespace

void ImagePyramid::build(const cv::Mat& image, const OpticalFlowOptions& options) {
  constexpr bool kWithGradients = true;
  constexpr bool kUseInputImage = false;  // it is the caller's, who may change it
  cv::buildOpticalFlowPyramid(image, levels_, cv::Size(options.window, options.window),
                              options.levels - 1, kWithGradients, cv::BORDER_REFLECT_101,
                              cv::BORDER_CONSTANT, kUseInputImage);
  noise_ = noiseDeviation(image);
}

double ImagePyramid::coarseScale() const {
  return static_cast<double>(image().cols) / coarsest().cols;
}

void OpticalFlow::track(const ImagePyramid& from, const ImagePyramid& to,
                        const std::vector<cv::Point2f>& points, std::vector<cv::Point2f>* tracked,
                        std::vector<std::uint8_t>* found) {
  found->assign(points.size(), 0);
  if (points.empty()) return;
  trackThere(from, to, points, tracked, found);
  checkWayBack(from, to, points, *tracked, found);
  retryLost(from, to, points, tracked, found);
}

void OpticalFlow::trackThere(const ImagePyramid& from, const ImagePyramid& to,
                             const std::vector<cv::Point2f>& points,
                             std::vector<cv::Point2f>* tracked, std::vector<std::uint8_t>* found) {
  cv::calcOpticalFlowPyrLK(from.levels(), to.levels(), points, *tracked, *found, residuals_,
                           cv::Size(options_.window, options_.window), options_.levels - 1,
                           criteriaOf(options_), cv::OPTFLOW_USE_INITIAL_FLOW,
                           flatness(from.noise()));
}

void OpticalFlow::checkWayBack(const ImagePyramid& from, const ImagePyramid& to,
                               const std::vector<cv::Point2f>& points,
                               const std::vector<cv::Point2f>& tracked,
                               std::vector<std::uint8_t>* found) {
  back_ = points;
  cv::calcOpticalFlowPyrLK(to.levels(), from.levels(), tracked, back_, found_back_, residuals_,
                           cv::Size(options_.window, options_.window), kWayBackLevels,
                           criteriaOf(options_), cv::OPTFLOW_USE_INITIAL_FLOW,
                           flatness(to.noise()));
  const double limit = options_.backward_tolerance * options_.backward_tolerance;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const cv::Point2f error = back_[i] - points[i];
    if (found_back_[i] == 0 || !(error.dot(error) <= limit)) (*found)[i] = 0;
  }
}

void OpticalFlow::retryLost(const ImagePyramid& from, const ImagePyramid& to,
                            const std::vector<cv::Point2f>& points,
                            std::vector<cv::Point2f>* tracked, std::vector<std::uint8_t>* found) {
  std::vector<std::size_t> lost;
  std::vector<cv::Point2f> lost_points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((*found)[i] != 0) continue;
    lost.push_back(i);
    lost_points.push_back(points[i]);
  }
  if (lost.empty()) return;
  std::vector<cv::Point2f> again = lost_points;
  std::vector<std::uint8_t> found_again;
  trackThere(from, to, lost_points, &again, &found_again);
  checkWayBack(from, to, lost_points, again, &found_again);
  for (std::size_t k = 0; k < lost.size(); ++k) {
    (*tracked)[lost[k]] = again[k];
    (*found)[lost[k]] = found_again[k];
  }
}

double brightnessRatio(const ImagePyramid& from, const ImagePyramid& to,
                       const std::vector<cv::Point2f>& points,
                       const std::vector<cv::Point2f>& tracked) {
  constexpr std::size_t kFewest = 10;
  const cv::Mat& a = from.coarsest();
  const cv::Mat& b = to.coarsest();
  const double scale = from.coarseScale();
  const auto greyAt = [scale](const cv::Mat& image, const cv::Point2f& pixel) {
    const int x = static_cast<int>(pixel.x / scale);
    const int y = static_cast<int>(pixel.y / scale);
    const bool inside = pixel.x >= 0 && pixel.y >= 0 && x < image.cols && y < image.rows;
    return inside ? static_cast<float>(image.at<std::uint8_t>(y, x)) : 0.0F;
  };
  std::vector<float> ratios;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float before = greyAt(a, points[i]);
    const float after = greyAt(b, tracked[i]);
    if (before >= kDarkest && after >= kDarkest && before < 250.0F && after < 250.0F) {
      ratios.push_back(after / before);
    }
  }
  if (ratios.size() < kFewest) return 1.0;
  std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
  return ratios[ratios.size() / 2];
}

}  // namespace vins::feature_tracker
