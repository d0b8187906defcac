#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "simulation/image_options.h"
#include "simulation/random.h"

namespace vins::simulation {

/// Turns the light that arrives at a lens into grey values: lens blur, vignetting, gain, photon and
/// read noise, 8 bits.
class ImageSensor {
 public:
  /// `stream` names the noise, the same for the same seed. Throws InputError for bad options.
  ImageSensor(const ImageOptions& options, std::uint64_t seed, const std::string& stream);

  /// Exposure, light and gain of the image stamped t_s; without an automatic exposure those of the
  /// options.
  ExposureSetting settingAt(double t_s) const;

  /// Gain of the image stamped t_s.
  double gainAt(double t_s) const;
  bool isBlackout(double t_s) const;

  /// CV_8UC1 image of a CV_32FC1 luminance. The noise is a function of seed, stream, frame_index
  /// and row.
  cv::Mat expose(const cv::Mat& luminance, double t_s, std::uint64_t frame_index) const;

 private:
  std::vector<float> blurredRow(const cv::Mat& luminance, int row) const;
  /// `setting` has the whole gain.
  void exposeRow(const std::vector<float>& light, int row, const ExposureSetting& setting,
                 Random& random, cv::Mat& image) const;

  ImageOptions options_;
  std::uint64_t seed_;
  std::string stream_;
  std::array<double, 3> drift_phases_;   ///< [rad]
  std::array<double, 3> drift_periods_;  ///< [s]
  std::vector<float> blur_;              ///< weights from the middle outwards
};

}  // namespace vins::simulation
