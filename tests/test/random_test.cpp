#include "simulation/random.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace vins::simulation {
namespace {

constexpr int kCount = 20000;

std::vector<double> normals(std::uint64_t seed, const std::string& stream) {
  Random random(seed, stream);
  std::vector<double> values(kCount);
  for (double& value : values) value = random.normal();
  return values;
}

/// Correlation of a with b shifted by `shift`.
double correlation(const std::vector<double>& a, const std::vector<double>& b, int shift) {
  double sum = 0.0;
  for (int i = 0; i + shift < kCount; ++i) {
    sum += a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(i + shift)];
  }
  return sum / (kCount - shift);
}

TEST(Random, SameSeedAndStreamGiveTheSameNumbersOnEveryComputer) {
  EXPECT_EQ(normals(7, "imu"), normals(7, "imu"));
  // Written down once, from the standard's definition of seed_seq and mt19937_64.
  EXPECT_EQ(Random(1, "imu").bits(), 1451402914840241731u);
}

TEST(Random, NeighbouringSeedsAndOtherStreamsShareNothingAtAnyShift) {
  const auto a = normals(7, "imu");
  // Five deviations of the correlation of independent numbers.
  const double bound = 5.0 / std::sqrt(kCount);
  for (const auto& b : {normals(8, "imu"), normals(7, "pixels")}) {
    for (int shift = 0; shift < 50; ++shift) {
      EXPECT_LT(std::abs(correlation(a, b, shift)), bound) << shift;
      EXPECT_LT(std::abs(correlation(b, a, shift)), bound) << shift;
    }
  }
}

TEST(Random, NormalsAreNormal) {
  double sum = 0.0, squares = 0.0, fourths = 0.0;
  for (const double x : normals(3, "moments")) {
    sum += x;
    squares += x * x;
    fourths += x * x * x * x;
  }
  const double n = kCount;
  EXPECT_NEAR(sum / n, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourths / n, 3.0, 5.0 * std::sqrt(96.0 / n));
}

TEST(Random, UniformsStayInRangeAndFillIt) {
  Random random(5, "uniform");
  double least = 1.0, most = 0.0, sum = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.uniform();
    least = std::min(least, x);
    most = std::max(most, x);
    sum += x;
  }
  EXPECT_GE(least, 0.0);
  EXPECT_LT(most, 1.0);
  EXPECT_LT(least, 1e-3);
  EXPECT_GT(most, 1.0 - 1e-3);
  EXPECT_NEAR(sum / kCount, 0.5, 5.0 / std::sqrt(12.0 * kCount));
}

}  // namespace
}  // namespace vins::simulation
