#include "simulation/image_simulator.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>

namespace vins::simulation {
namespace {

/// Less motion than this during the exposure is no blur worth rendering [px].
constexpr double kStillMotion = 0.3;
/// Instants of the exposure lie about this far apart where the image moves fastest [px]. The
/// spectrum of such a comb repeats beyond 0.8 cycles per pixel, where the pixels see nothing.
constexpr double kMotionPerSample = 1.25;
constexpr int kMaxSamples = 12;
/// Slack for points that lie on the surface themselves, relative and [m].
constexpr double kOnSurface = 1e-6;

cv::Mat throughJpeg(const cv::Mat& image, int quality) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

}  // namespace

ImageSimulator::ImageSimulator(std::shared_ptr<const Scene> scene,
                               std::shared_ptr<const camera_model::Camera> camera, const Pose& T_bc,
                               const ImageOptions& options, std::uint64_t seed,
                               const std::string& stream)
    : scene_(std::move(scene)),
      camera_(std::move(camera)),
      T_bc_(T_bc),
      options_(options),
      sensor_(options, seed, stream),
      renderer_(scene_, *camera_) {}

cv::Mat ImageSimulator::render(const Trajectory& T_wb, double t_s,
                               std::uint64_t frame_index) const {
  const camera_model::ImageSize size = camera_->imageSize();
  const cv::Mat luminance = sensor_.isBlackout(t_s)
                                ? cv::Mat::zeros(size.height, size.width, CV_32FC1)
                                : renderer_.render(plan(T_wb, t_s), options_.threads);
  const cv::Mat image = sensor_.expose(luminance, t_s, frame_index);
  return options_.jpeg_quality > 0 ? throughJpeg(image, options_.jpeg_quality) : image;
}

double ImageSimulator::timeOfRow(double t_s, double row) const {
  return t_s + row / camera_->imageSize().height * options_.rolling_shutter_readout_s;
}

std::optional<Eigen::Vector3d> ImageSimulator::pointAt(const Pose& T_wb,
                                                       const Eigen::Vector2d& pixel,
                                                       double t_s) const {
  const auto bearing = camera_->unproject(pixel);
  if (!bearing) return std::nullopt;
  const Pose T_wc = T_wb * T_bc_;
  const Eigen::Vector3d direction = T_wc.rotation * *bearing;
  const auto hit = scene_->intersect(T_wc.position, direction, t_s);
  if (!hit) return std::nullopt;
  return T_wc.position + hit->distance * direction;
}

std::optional<Eigen::Vector2d> ImageSimulator::project(const Pose& T_wb,
                                                       const Eigen::Vector3d& p_w) const {
  return camera_->project((T_wb * T_bc_).inverse() * p_w);
}

bool ImageSimulator::isVisible(const Pose& T_wb, const Eigen::Vector3d& p_w, double t_s) const {
  const auto pixel = project(T_wb, p_w);
  if (!pixel || !camera_->contains(*pixel)) return false;
  const Pose T_wc = T_wb * T_bc_;
  const Eigen::Vector3d ray = p_w - T_wc.position;
  const double distance = ray.norm();
  const auto hit = scene_->intersect(T_wc.position, ray / distance, t_s);
  return !hit || hit->distance >= distance * (1.0 - kOnSurface) - kOnSurface;
}

double ImageSimulator::pixelMotion(const Pose& T_wb_begin, const Pose& T_wb_end,
                                   const Eigen::Vector2d& pixel, double t_s,
                                   double exposure_s) const {
  const auto bearing = camera_->unproject(pixel);
  if (!bearing) return 0.0;
  const Pose T_wc = T_wb_begin * T_bc_;
  const Eigen::Vector3d direction = T_wc.rotation * *bearing;
  const auto hit = scene_->intersect(T_wc.position, direction, t_s);
  if (!hit) return 0.0;
  Eigen::Vector3d p_w = T_wc.position + hit->distance * direction;
  if (hit->object >= 0) {
    const auto& pose_at = scene_->movingObjects()[hit->object].pose_at;
    p_w = pose_at(t_s + exposure_s) * (pose_at(t_s).inverse() * p_w);
  }
  const auto moved = project(T_wb_end, p_w);
  return moved ? (*moved - pixel).norm() : 0.0;
}

int ImageSimulator::exposureSamples(const Trajectory& T_wb, double t_s, double exposure_s) const {
  const double begin_s = t_s - 0.5 * exposure_s;
  const Pose begin = T_wb(begin_s), end = T_wb(begin_s + exposure_s);
  const camera_model::ImageSize size = camera_->imageSize();
  double largest = 0.0;
  for (double v = 0.05; v < 1.0; v += 0.15) {
    for (double u = 0.05; u < 1.0; u += 0.1) {
      const Eigen::Vector2d pixel(u * size.width, v * size.height);
      largest = std::max(largest, pixelMotion(begin, end, pixel, begin_s, exposure_s));
    }
  }
  if (largest < kStillMotion) return 1;
  return std::clamp(static_cast<int>(std::ceil(largest / kMotionPerSample)), 2, kMaxSamples);
}

ExposurePlan ImageSimulator::plan(const Trajectory& T_wb, double t_s) const {
  ExposurePlan plan;
  plan.rolling = options_.rolling_shutter_readout_s > 0.0;
  const double middle_row = 0.5 * camera_->imageSize().height;
  const double exposure_s = sensor_.settingAt(t_s).exposure_s;
  plan.samples = exposureSamples(T_wb, timeOfRow(t_s, middle_row), exposure_s);
  // n instants in the middles of n equal parts have 1 - 1 / n^2 of the variance of the whole
  // exposure; spread by the root of that they blur as much as the exposure does. For n = 2 these
  // are Gauss's points.
  const double n = plan.samples;
  const double spread = plan.samples > 1 ? 1.0 / std::sqrt(1.0 - 1.0 / (n * n)) : 0.0;
  const int rows = plan.rolling ? camera_->imageSize().height : 1;
  for (int row = 0; row < rows; ++row) {
    for (int sample = 0; sample < plan.samples; ++sample) {
      const double share = spread * ((sample + 0.5) / n - 0.5);
      const double sample_s = timeOfRow(t_s, row) + share * exposure_s;
      plan.instants.push_back({T_wb(sample_s) * T_bc_, sample_s});
    }
  }
  return plan;
}

}  // namespace vins::simulation
