#include "simulation/image_options.h"

#include <ostream>
#include <sstream>
#include <string>

#include "vins_core/input_error.h"

namespace vins::simulation {
namespace {

void require(bool allowed, const char* option, double found, const char* what) {
  if (allowed) return;
  std::ostringstream message;
  message << "image simulation: " << option << ": found " << found << "; allowed: " << what;
  throw InputError(message.str());
}

/// NaN is in no range.
void requireRange(const char* option, double value, double min, double max, const char* what) {
  require(value >= min && value <= max, option, value, what);
}

}  // namespace

void ImageOptions::validate() const {
  requireRange("exposure_s", exposure_s, 0.0, 1.0, "0 to 1 s");
  requireRange("rolling_shutter_readout_s", rolling_shutter_readout_s, 0.0, 1.0, "0 to 1 s");
  requireRange("lens_blur_px", lens_blur_px, 0.0, 20.0, "0 to 20 px");
  requireRange("vignetting", vignetting, 0.0, 1.0, "0 to 1");
  requireRange("gain", gain, 1e-3, 1e3, "0.001 to 1000");
  requireRange("gain_drift", gain_drift, 0.0, 2.0, "0 to 2");
  requireRange("gain_drift_period_s", gain_drift_period_s, 1e-2, 1e6, "0.01 to 1e6 s");
  requireRange("full_well_electrons", full_well_electrons, 0.0, 1e9, "0 to 1e9");
  requireRange("read_noise_dn", read_noise_dn, 0.0, 255.0, "0 to 255 grey values");
  requireRange("read_noise_electrons", read_noise_electrons, 0.0, 1e4, "0 to 10000 electrons");
  requireRange("jpeg_quality", jpeg_quality, 0, 100, "0 to 100");
  requireRange("threads", threads, 1, 256, "1 to 256");
  for (const GainStep& step : gain_steps) {
    requireRange("gain_steps: t_s", step.t_s, -1e12, 1e12, "a time");
    requireRange("gain_steps: factor", step.factor, 1e-3, 1e3, "0.001 to 1000");
  }
  for (const ExposureSetting& setting : exposures) {
    requireRange("exposures: exposure_s", setting.exposure_s, 0.0, 1.0, "0 to 1 s");
    requireRange("exposures: light", setting.light, 0.0, 1e3, "0 to 1000");
    requireRange("exposures: gain", setting.gain, 0.0, 1e3, "0 to 1000");
  }
  for (const TimeInterval& blackout : blackouts) {
    require(blackout.end_s > blackout.begin_s, "blackouts: end_s", blackout.end_s,
            "a time after begin_s");
  }
}

std::ostream& operator<<(std::ostream& stream, const ImageOptions& options) {
  stream << "exposure_s: " << options.exposure_s
         << "\nrolling_shutter_readout_s: " << options.rolling_shutter_readout_s
         << "\nlens_blur_px: " << options.lens_blur_px << "\nvignetting: " << options.vignetting
         << "\ngain: " << options.gain << "\ngain_drift: " << options.gain_drift
         << "\ngain_drift_period_s: " << options.gain_drift_period_s << "\ngain_steps:";
  for (const GainStep& step : options.gain_steps) stream << " " << step.t_s << ":" << step.factor;
  stream << "\nfull_well_electrons: " << options.full_well_electrons
         << "\nread_noise_dn: " << options.read_noise_dn
         << "\nread_noise_electrons: " << options.read_noise_electrons
         << "\njpeg_quality: " << options.jpeg_quality
         << "\nexposure settings: " << options.exposures.size() << "\nblackouts:";
  for (const TimeInterval& blackout : options.blackouts) {
    stream << " [" << blackout.begin_s << ", " << blackout.end_s << ")";
  }
  return stream << "\nthreads: " << options.threads << "\n";
}

}  // namespace vins::simulation
