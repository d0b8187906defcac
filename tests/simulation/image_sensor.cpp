#include "simulation/image_sensor.h"

#include <algorithm>
#include <cmath>

#include "simulation/parallel_for.h"

namespace vins::simulation {
namespace {

constexpr double kWhite = 255.0;
/// So many rows share a stream of noise: starting one takes as long as half a row of numbers.
constexpr int kRowsPerStream = 8;

/// A random number of mean 0 and variance 1: the sum of four uniform ones of 16 bits each, normal
/// but for the tails beyond 3 (kurtosis 2.7). Takes no function of the mathematical library, whose
/// last digit depends on the machine.
double nearlyNormal(Random& random) {
  const std::uint64_t bits = random.bits();
  const auto sum = static_cast<double>((bits & 0xffff) + (bits >> 16 & 0xffff) +
                                       (bits >> 32 & 0xffff) + (bits >> 48));
  const double mean = 2.0 * 65535.0, deviation = 65536.0 * 0.57735026918962576;  // sqrt(4 / 12)
  return (sum - mean) / deviation;
}

/// Weights of a Gaussian from the middle outwards, both sides together of sum one.
std::vector<float> gaussianWeights(double sigma) {
  std::vector<double> weights = {1.0};
  double sum = 1.0;
  for (int i = 1; i <= std::ceil(3.0 * sigma); ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    sum += 2.0 * weights.back();
  }
  std::vector<float> result;
  for (const double weight : weights) result.push_back(static_cast<float>(weight / sum));
  return result;
}

}  // namespace

ImageSensor::ImageSensor(const ImageOptions& options, std::uint64_t seed, const std::string& stream)
    : options_(options), seed_(seed), stream_(stream) {
  options_.validate();
  blur_ = gaussianWeights(options_.lens_blur_px);
  Random random(seed, stream + " gain");
  // Incommensurate periods: the sum does not repeat.
  const std::array<double, 3> ratios = {0.61, 1.0, 1.73};
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    drift_phases_[i] = random.uniform(0.0, 2.0 * M_PI);
    drift_periods_[i] = ratios[i] * options_.gain_drift_period_s;
  }
}

ExposureSetting ImageSensor::settingAt(double t_s) const {
  const std::vector<ExposureSetting>& settings = options_.exposures;
  if (settings.empty()) return {t_s, options_.exposure_s, 1.0, 1.0};
  const auto next = std::upper_bound(settings.begin(), settings.end(), t_s,
                                     [](double t, const ExposureSetting& s) { return t < s.t_s; });
  if (next == settings.begin()) return settings.front();
  if (next == settings.end()) return settings.back();
  const ExposureSetting &a = *(next - 1), &b = *next;
  const double share = (t_s - a.t_s) / (b.t_s - a.t_s);
  const auto between = [share](double from, double to) { return from + share * (to - from); };
  return {t_s, between(a.exposure_s, b.exposure_s), between(a.light, b.light),
          between(a.gain, b.gain)};
}

double ImageSensor::gainAt(double t_s) const {
  double waves = 0.0;
  for (std::size_t i = 0; i < drift_phases_.size(); ++i) {
    waves += std::sin(2.0 * M_PI * t_s / drift_periods_[i] + drift_phases_[i]);
  }
  // Each wave has variance 1 / 2.
  double gain = options_.gain * std::exp(options_.gain_drift * std::sqrt(2.0 / 3.0) * waves);
  for (const GainStep& step : options_.gain_steps) {
    if (t_s >= step.t_s) gain *= step.factor;
  }
  return gain;
}

bool ImageSensor::isBlackout(double t_s) const {
  return std::any_of(options_.blackouts.begin(), options_.blackouts.end(),
                     [t_s](const TimeInterval& i) { return t_s >= i.begin_s && t_s < i.end_s; });
}

cv::Mat ImageSensor::expose(const cv::Mat& luminance, double t_s, std::uint64_t frame_index) const {
  cv::Mat image(luminance.size(), CV_8UC1);
  ExposureSetting setting = settingAt(t_s);
  setting.gain *= gainAt(t_s);
  const int blocks = (luminance.rows + kRowsPerStream - 1) / kRowsPerStream;
  parallelFor(blocks, options_.threads, [&](int block) {
    Random random(seed_,
                  stream_ + " noise " + std::to_string(frame_index) + " " + std::to_string(block));
    const int first = block * kRowsPerStream;
    for (int row = first; row < std::min(first + kRowsPerStream, luminance.rows); ++row) {
      exposeRow(blurredRow(luminance, row), row, setting, random, image);
    }
  });
  return image;
}

std::vector<float> ImageSensor::blurredRow(const cv::Mat& luminance, int row) const {
  const int width = luminance.cols, reach = static_cast<int>(blur_.size()) - 1;
  // Rows and columns beyond the image are taken to be like its outermost ones.
  std::vector<float> column_sums(width + 2 * reach, 0.0F);
  for (int offset = -reach; offset <= reach; ++offset) {
    const float* const in = luminance.ptr<float>(std::clamp(row + offset, 0, luminance.rows - 1));
    const float weight = blur_[std::abs(offset)];
    for (int x = 0; x < width; ++x) column_sums[x + reach] += weight * in[x];
  }
  std::fill_n(column_sums.begin(), reach, column_sums[reach]);
  std::fill_n(column_sums.end() - reach, reach, column_sums[reach + width - 1]);
  std::vector<float> blurred(width, 0.0F);
  for (int offset = -reach; offset <= reach; ++offset) {
    const float* const in = column_sums.data() + reach + offset;
    const float weight = blur_[std::abs(offset)];
    for (int x = 0; x < width; ++x) blurred[x] += weight * in[x];
  }
  return blurred;
}

void ImageSensor::exposeRow(const std::vector<float>& light, int row,
                            const ExposureSetting& setting, Random& random, cv::Mat& image) const {
  const double gain = setting.gain;
  const double full_well = options_.full_well_electrons;
  const double photon_variance = full_well > 0.0 ? gain * gain * kWhite * kWhite / full_well : 0.0;
  const double pixel_noise =
      full_well > 0.0 ? gain * kWhite * options_.read_noise_electrons / full_well : 0.0;
  const double read_variance =
      options_.read_noise_dn * options_.read_noise_dn + pixel_noise * pixel_noise;
  const bool noisy = photon_variance > 0.0 || read_variance > 0.0;
  const double middle_x = 0.5 * (image.cols - 1), middle_y = 0.5 * (image.rows - 1);
  const double loss =
      options_.vignetting / std::max(middle_x * middle_x + middle_y * middle_y, 1.0);
  std::uint8_t* const out = image.ptr<std::uint8_t>(row);
  for (int x = 0; x < image.cols; ++x) {
    const double dx = x - middle_x, dy = row - middle_y;
    const double arriving = setting.light * light[x] * (1.0 - loss * (dx * dx + dy * dy));
    double grey = gain * kWhite * arriving;
    // Photon and read noise at once: the sum of two normal numbers is one.
    if (noisy) grey += std::sqrt(photon_variance * arriving + read_variance) * nearlyNormal(random);
    out[x] = static_cast<std::uint8_t>(std::clamp(grey, 0.0, kWhite) + 0.5);
  }
}

}  // namespace vins::simulation
