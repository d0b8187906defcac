#include "simulation/auto_exposure.h"

#include <algorithm>
#include <cmath>

#include "vins_core/option_check.h"

namespace vins::simulation {
namespace {

constexpr double kInterval = 0.1;  ///< between settings [s]
constexpr int kColumns = 16, kRows = 9;

/// The factor from light to grey, as a share of white, that gives the image the mean `target`.
/// What is blown out counts as white, which makes it an equation: solved by bisection.
double factorFor(const std::vector<double>& luminances, double target) {
  double low = 0.01, high = 100.0;
  for (int i = 0; i < 30; ++i) {
    const double factor = std::sqrt(low * high);
    double sum = 0.0;
    for (const double luminance : luminances) sum += std::min(1.0, factor * luminance);
    (sum < target * static_cast<double>(luminances.size()) ? low : high) = factor;
  }
  return std::sqrt(low * high);
}

std::vector<double> luminancesSeen(const Scene& scene, const camera_model::Camera& camera,
                                   const Pose& T_wc, double t_s) {
  std::vector<double> luminances;
  const camera_model::ImageSize size = camera.imageSize();
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const auto bearing = camera.unproject(
          {(column + 0.5) * size.width / kColumns, (row + 0.5) * size.height / kRows});
      if (!bearing) continue;
      const auto hit = scene.intersect(T_wc.position, T_wc.rotation * *bearing, t_s);
      luminances.push_back(hit ? hit->luminance : 0.0);
    }
  }
  return luminances;
}

}  // namespace

void AutoExposure::validate() const {
  const auto require = [](bool allowed, const char* name, double value, const char* what) {
    if (!allowed) refuseOption("automatic exposure", name, value, what);
  };
  require(target > 0.0 && target < 1.0, "target", target, "between 0 and 1");
  require(reference_s > 0.0, "reference exposure", reference_s, "more than 0 s");
  require(min_exposure_s > 0.0, "least exposure", min_exposure_s, "more than 0 s");
  require(max_exposure_s >= min_exposure_s && max_exposure_s <= 1.0, "greatest exposure",
          max_exposure_s, "from the least one to 1 s");
  require(max_gain >= 1.0, "greatest gain", max_gain, "at least 1");
  require(lag_s >= 0.0, "lag", lag_s, "at least 0 s");
}

std::vector<ExposureSetting> planExposure(const Scene& scene, const camera_model::Camera& camera,
                                          const std::function<Pose(double t_s)>& T_wc, double begin,
                                          double end, const AutoExposure& options) {
  options.validate();
  const double least = options.min_exposure_s / options.reference_s;
  const double most = options.max_gain * options.max_exposure_s / options.reference_s;
  const double follow = 1.0 - std::exp(-kInterval / std::max(options.lag_s, 1e-3));
  std::vector<ExposureSetting> settings;
  double log_factor = 0.0;
  for (double t = begin; t < end + kInterval; t += kInterval) {
    const double wanted = factorFor(luminancesSeen(scene, camera, T_wc(t), t), options.target);
    const double log_wanted = std::log(std::clamp(wanted, least, most));
    log_factor = settings.empty() ? log_wanted : log_factor + follow * (log_wanted - log_factor);
    const double time = std::exp(log_factor) * options.reference_s;
    ExposureSetting setting;
    setting.t_s = t;
    setting.exposure_s = std::clamp(time, options.min_exposure_s, options.max_exposure_s);
    setting.light = setting.exposure_s / options.reference_s;
    setting.gain = std::clamp(time / setting.exposure_s, 1.0, options.max_gain);
    settings.push_back(setting);
  }
  return settings;
}

}  // namespace vins::simulation
