#include "simulation/random.h"

#include <cmath>
#include <vector>

namespace vins::simulation {
namespace {

std::mt19937_64 seededEngine(std::uint64_t seed, const std::string& stream) {
  std::vector<std::uint32_t> words = {static_cast<std::uint32_t>(seed),
                                      static_cast<std::uint32_t>(seed >> 32)};
  for (const char c : stream) words.push_back(static_cast<unsigned char>(c));
  std::seed_seq sequence(words.begin(), words.end());
  return std::mt19937_64(sequence);
}

}  // namespace

Random::Random(std::uint64_t seed, const std::string& stream)
    : engine_(seededEngine(seed, stream)) {}

double Random::uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

double Random::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  // Box and Muller 1958; 1 - uniform() is never zero.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = 2.0 * M_PI * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

Eigen::Vector3d Random::normal3() {
  const double x = normal(), y = normal(), z = normal();
  return {x, y, z};
}

}  // namespace vins::simulation
