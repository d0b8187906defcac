#pragma once

#include <cstdint>
#include <vector>

namespace vins::simulation {

/// When a camera takes its images. The defaults are those of a machine camera: an exact period.
struct FrameTiming {
  double rate = 20.0;              ///< images per second [Hz]
  double slow_rate = 0.0;          ///< in stretches of some seconds [Hz]; 0: never
  double drop_probability = 0.0;   ///< of each image
  double burst_probability = 0.0;  ///< of losing 2 to 6 images in a row, at each image
  double stamp_jitter_s = 0.0;     ///< standard deviation of the stamps' errors [s]

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// One image: when it is taken, and when its stamp says so [s from the start].
struct FrameInstant {
  double taken_s = 0.0;
  double stamped_s = 0.0;
};

/// The images from 0 to `duration` [s], at most. Stamps rise by at least a millisecond. The first
/// image is neither dropped nor jittered. The same for the same seed.
std::vector<FrameInstant> frameInstants(const FrameTiming& timing, double duration,
                                        std::uint64_t seed);

}  // namespace vins::simulation
