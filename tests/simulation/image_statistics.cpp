#include "simulation/image_statistics.h"

#include <algorithm>
#include <cmath>
#include <ostream>

#include <opencv2/imgproc.hpp>

namespace vins::simulation {
namespace {

constexpr double kDistance_px = 25.0;  ///< between corners
constexpr int kLargestWidth = 1000;    ///< of an image that is not halved [px]

cv::Mat atCommonScale(const cv::Mat& image) {
  if (image.cols <= kLargestWidth) return image;
  cv::Mat half;
  cv::resize(image, half, {}, 0.5, 0.5, cv::INTER_AREA);
  return half;
}

/// Root of the smaller eigenvalue of the mean structure tensor over 3 x 3 px [grey values / px].
cv::Mat cornerStrength(const cv::Mat& image) {
  cv::Mat eigenvalue, strength;
  // OpenCV scales Sobel's sum of 8 for images of 8 bits by 1 / 255, and by block and aperture.
  cv::cornerMinEigenVal(image, eigenvalue, 3, 3);
  const double scale = 255.0 * (1 << 2) * 3.0 / 8.0;
  cv::sqrt(cv::max(eigenvalue, 0.0), strength);
  // The box filter sums nine products; their mean is meant.
  return strength * (scale / 3.0);
}

/// Strengths of the strongest corners that keep their distance, strongest first.
std::vector<double> cornersOf(const cv::Mat& image) {
  const cv::Mat strength = cornerStrength(image);
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(image, corners, 0, 1e-6, kDistance_px);
  std::vector<double> strengths;
  for (const cv::Point2f& p : corners) {
    strengths.push_back(strength.at<float>(static_cast<int>(p.y), static_cast<int>(p.x)));
  }
  std::sort(strengths.rbegin(), strengths.rend());
  return strengths;
}

cv::Mat gradientMagnitude(const cv::Mat& image) {
  cv::Mat x, y, magnitude;
  cv::Sobel(image, x, CV_32F, 1, 0, 3, 1.0 / 8.0);
  cv::Sobel(image, y, CV_32F, 0, 1, 3, 1.0 / 8.0);
  cv::magnitude(x, y, magnitude);
  return magnitude;
}

double shareOf(const cv::Mat& mask) {
  return cv::countNonZero(mask) / static_cast<double>(mask.total());
}

double deviation(const cv::Mat& image) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(image, mean, deviation);
  return deviation[0];
}

/// Of a mask that sees neither constants nor slopes, after J. Immerkaer, "Fast noise variance
/// estimation", CVIU 1996; the 20th percentile of 16 x 16 px blocks, for edges are not noise.
double noiseOf(const cv::Mat& image) {
  const cv::Mat mask = (cv::Mat_<float>(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1);
  cv::Mat response;
  cv::filter2D(image, response, CV_32F, mask / 6.0);
  std::vector<double> deviations;
  for (int y = 0; y + 16 <= image.rows; y += 16) {
    for (int x = 0; x + 16 <= image.cols; x += 16) {
      const cv::Rect block(x, y, 16, 16);
      const double grey = cv::mean(image(block))[0];
      if (grey < 5.0 || grey > 245.0) continue;
      deviations.push_back(std::sqrt(cv::mean(response(block).mul(response(block)))[0]));
    }
  }
  if (deviations.empty()) return 0.0;
  const auto place = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 5);
  std::nth_element(deviations.begin(), place, deviations.end());
  return *place;
}

void addGradients(const cv::Mat& image, ImageStatistics* sum) {
  const cv::Mat gradient = gradientMagnitude(image);
  double below = 0.0;
  for (std::size_t i = 0; i < ImageStatistics::kGradientEdges.size(); ++i) {
    const double share = shareOf(gradient < ImageStatistics::kGradientEdges[i]);
    sum->gradient_histogram[i] += share - below;
    below = share;
  }
  sum->gradient_histogram.back() += 1.0 - below;
  cv::Mat laplacian;
  cv::Laplacian(image, laplacian, CV_32F);
  cv::Mat squares = gradient.mul(gradient);
  sum->sharpness += deviation(laplacian) / std::max(1e-6, std::sqrt(cv::mean(squares)[0]));
}

void addCorners(const cv::Mat& image, ImageStatistics* sum) {
  const std::vector<double> strengths = cornersOf(image);
  for (std::size_t i = 0; i < ImageStatistics::kStrengths.size(); ++i) {
    sum->corners[i] +=
        static_cast<double>(std::count_if(strengths.begin(), strengths.end(), [&](double strength) {
          return strength >= ImageStatistics::kStrengths[i];
        }));
  }
  const std::array<double, 3> quantiles = {0.5, 0.75, 0.9};
  for (std::size_t i = 0; i < quantiles.size() && !strengths.empty(); ++i) {
    const double place = (1.0 - quantiles[i]) * static_cast<double>(strengths.size() - 1);
    sum->strength_quantiles[i] += strengths[static_cast<std::size_t>(place)];
  }
}

}  // namespace

void ImageStatisticsMeter::add(const cv::Mat& image) {
  const cv::Mat scaled = atCommonScale(image);
  ++sum_.images;
  sum_.mean_grey += cv::mean(scaled)[0];
  sum_.black_share += shareOf(scaled <= 5);
  sum_.white_share += shareOf(scaled >= 250);
  sum_.noise += noiseOf(scaled);
  addGradients(scaled, &sum_);
  addCorners(scaled, &sum_);
}

ImageStatistics ImageStatisticsMeter::result() const {
  ImageStatistics mean = sum_;
  if (mean.images == 0) return mean;
  const double count = mean.images;
  for (double* value :
       {&mean.mean_grey, &mean.black_share, &mean.white_share, &mean.noise, &mean.sharpness}) {
    *value /= count;
  }
  for (double& value : mean.corners) value /= count;
  for (double& value : mean.strength_quantiles) value /= count;
  for (double& value : mean.gradient_histogram) value /= count;
  return mean;
}

int TrackCounter::add(const cv::Mat& image) { return tracker_.add(atCommonScale(image)); }

std::ostream& operator<<(std::ostream& out, const ImageStatistics& s) {
  out << "images: " << s.images << "\nmean grey: " << s.mean_grey
      << "\nblack, white [%]: " << 100.0 * s.black_share << ", " << 100.0 * s.white_share
      << "\nnoise [grey]: " << s.noise << "\ncorners per image of at least";
  for (std::size_t i = 0; i < s.corners.size(); ++i) {
    out << (i == 0 ? " " : ", ") << ImageStatistics::kStrengths[i] << ": " << s.corners[i];
  }
  out << "\ncorner strength at 50, 75, 90 %:";
  for (const double strength : s.strength_quantiles) out << " " << strength;
  out << "\ngradient below";
  for (const double edge : ImageStatistics::kGradientEdges) out << " " << edge;
  out << ", above [%]:";
  for (const double share : s.gradient_histogram) out << " " << 100.0 * share;
  return out << "\nsharpness: " << s.sharpness << "\ntracks kept: " << s.tracks << "\n";
}

}  // namespace vins::simulation
