#pragma once

#include <cstdint>
#include <random>
#include <string>

#include <Eigen/Core>

namespace vins::simulation {

/// Random numbers that are the same on every computer: the engine is the standard's, the
/// distributions are written here, because the standard leaves theirs to the library. Every
/// consumer names a stream of its own ("imu", "pixel noise"), so that switching one effect off does
/// not change another. Seed and stream go through std::seed_seq, which mixes them over the whole
/// state: neighbouring seeds share no noise.
class Random {
 public:
  Random(std::uint64_t seed, const std::string& stream);

  /// Whole number, all 64 bits random.
  std::uint64_t bits() { return engine_(); }

  /// In [0, 1), 53 bits.
  double uniform();
  double uniform(double from, double to) { return from + (to - from) * uniform(); }

  /// Mean zero, standard deviation one.
  double normal();
  Eigen::Vector3d normal3();

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace vins::simulation
