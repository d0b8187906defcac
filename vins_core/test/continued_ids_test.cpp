#include "vins_core/continued_ids.h"

#include <gtest/gtest.h>

namespace vins {
namespace {

TEST(ContinuedIds, AreTheIdsThemselvesUntilTheProgramIsStartedAgain) {
  ContinuedIds ids;
  EXPECT_EQ(ids.continued(0), 0);
  EXPECT_EQ(ids.continued(7), 7);
  EXPECT_EQ(ids.original(7), 7);
}

TEST(ContinuedIds, GoOnAboveAllThatHaveBeen) {
  ContinuedIds ids;
  ids.continued(7);
  ids.continued(3);
  ids.startAgain();
  EXPECT_EQ(ids.continued(0), 8);
  EXPECT_EQ(ids.continued(1), 9);
  ids.startAgain();
  EXPECT_EQ(ids.continued(0), 10);
  EXPECT_EQ(ids.original(10), 0);
  EXPECT_LT(ids.original(9), 0) << "of a former run";
}

TEST(ContinuedIds, LookingUpLeavesNoTrace) {
  ContinuedIds ids;
  ids.continued(2);
  EXPECT_EQ(ids.lookUp(50), 50);
  ids.startAgain();
  EXPECT_EQ(ids.lookUp(0), 3);
}

}  // namespace
}  // namespace vins
