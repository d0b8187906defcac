#include "vins_core/yaml_text.h"

#include <limits>

#include <gtest/gtest.h>

#include "vins_core/parameters.h"

namespace vins {
namespace {

TEST(YamlText, NumbersReadBackExactly) {
  for (const double value : {0.1, 1.0 / 3.0, -2.0e-300, 1e22, 458.654, 5e-324,
                             std::numeric_limits<double>::max(), 123456789.0}) {
    EXPECT_EQ(Parameters::parse("a: " + exactNumber(value), "f").number("a"), value);
  }
}

TEST(YamlText, IsShortAndNoInteger) {
  EXPECT_EQ(exactNumber(0.1), "0.1");
  EXPECT_EQ(exactNumber(150.0), "150.0");
  EXPECT_EQ(exactNumber(0.0), "0.0");
}

TEST(YamlText, MatricesReadBackExactly) {
  const Eigen::MatrixXd matrix =
      (Eigen::MatrixXd(2, 3) << 1.0 / 3.0, 2.0, -3.0, 1e-17, 0.0, 1e300).finished();
  EXPECT_EQ(Parameters::parse(opencvMatrix("T", matrix), "f").matrix("T", 2, 3), matrix);
}

}  // namespace
}  // namespace vins
