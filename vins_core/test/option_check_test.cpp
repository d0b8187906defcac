#include "vins_core/option_check.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins {
namespace {

TEST(OptionCheck, TakesWhatIsAllowed) {
  EXPECT_NO_THROW(requireWithin("tracker", "count", 1.0, {1, 5}));
  EXPECT_NO_THROW(requireWithin("tracker", "count", 5.0, {1, 5}));
  EXPECT_NO_THROW(requirePositive("tracker", "distance", 1e-300));
}

TEST(OptionCheck, RefusesTheRestAndWhatIsNoNumber) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.99, 5.01, -inf, inf, std::nan("")}) {
    EXPECT_THROW(requireWithin("tracker", "count", bad, {1, 5}), InputError) << bad;
  }
  // Without bounds, too, it has to be a number.
  EXPECT_THROW(requireWithin("tracker", "count", inf, {}), InputError);
  for (const double bad : {0.0, -1.0, inf, std::nan("")}) {
    EXPECT_THROW(requirePositive("tracker", "distance", bad), InputError) << bad;
  }
}

TEST(OptionCheck, SaysWhoseOptionItIsAndWhatIsAllowed) {
  try {
    requireWithin("tracker", "count", 7.0, {1, 5});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "tracker: count is 7; allowed: 1 to 5");
  }
}

}  // namespace
}  // namespace vins
