#pragma once

#include <iosfwd>
#include <vector>

namespace vins::simulation {

/// A jump of the camera's gain.
struct GainStep {
  double t_s = 0.0;     ///< from this time on [s]
  double factor = 1.0;  ///< the gain is multiplied by this
};

/// What an automatic exposure has chosen at a time.
struct ExposureSetting {
  double t_s = 0.0;         ///< [s]
  double exposure_s = 0.0;  ///< the shutter's time [s]
  double light = 1.0;       ///< luminance 1 fills the sensor to this share of white
  double gain = 1.0;        ///< of the electronics, on top of ImageOptions::gain
};

/// From begin_s on, until just before end_s [s].
struct TimeInterval {
  double begin_s = 0.0;
  double end_s = 0.0;
};

/// How a simulated camera takes its pictures. Grey values are linear in the light (no gamma).
struct ImageOptions {
  /// The shutter's time [s]. A global shutter's image at stamp t collects light from
  /// t - exposure / 2 to t + exposure / 2.
  double exposure_s = 0.005;
  /// The settings of an automatic exposure by rising time, linear between, in place of exposure_s.
  std::vector<ExposureSetting> exposures;
  /// Time from the first row to the one below the last [s]; 0 is a global shutter. The stamp t is
  /// the middle of the exposure of the first row: the middle for row r is t + r / height * readout
  /// (VINS-Mono's rolling_shutter_tr).
  double rolling_shutter_readout_s = 0.0;
  /// Standard deviation of the lens's Gaussian blur [px]; 0 is none.
  double lens_blur_px = 0.6;
  /// Share of the light that the image's corners lose; grows with the squared distance from the
  /// image's middle.
  double vignetting = 0.25;
  /// Luminance 1 gives grey value 255 at gain 1.
  double gain = 1.0;
  /// Standard deviation of the logarithm of the gain, which wanders smoothly as that of an
  /// automatic exposure does: a sum of three sinusoids with periods about gain_drift_period_s.
  double gain_drift = 0.0;
  double gain_drift_period_s = 8.0;
  std::vector<GainStep> gain_steps;
  /// Electrons at grey value 255 and gain 1, with Poisson noise (as a normal distribution): the
  /// variance of a grey value g is gain * 255 g / full_well. 0 is no photon noise.
  double full_well_electrons = 10000.0;
  /// Standard deviation of the electronics' noise [grey values], at any gain.
  double read_noise_dn = 0.7;
  /// Standard deviation of the pixels' own noise [electrons], which grows with the gain.
  double read_noise_electrons = 0.0;
  /// Of the JPEG through which the image goes, 1 to 100; 0: none.
  int jpeg_quality = 0;
  /// Images with a stamp in one of these see nothing: black but for the read noise.
  std::vector<TimeInterval> blackouts;
  /// Worker threads; the images do not depend on it.
  int threads = 2;

  /// Throws InputError naming the option, what was found and what is allowed.
  void validate() const;
};

/// One line per option.
std::ostream& operator<<(std::ostream& stream, const ImageOptions& options);

}  // namespace vins::simulation
