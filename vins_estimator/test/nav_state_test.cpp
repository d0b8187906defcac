#include "vins_estimator/inertial/nav_state.h"

#include <gtest/gtest.h>

#include "estimator_test_values.h"

namespace vins::estimator {
namespace {

TEST(NavState, MinusUndoesPlus) {
  testing::Random random(1);
  for (int i = 0; i < 20; ++i) {
    const NavState state = random.navState();
    Vector15d d;
    for (double& x : d) x = 0.5 * random.normal();
    EXPECT_LT((minus(plus(state, d), state) - d).norm(), 1e-12);
  }
}

TEST(NavState, SeesWhatIsNotFinite) {
  testing::Random random(2);
  NavState state = random.navState();
  EXPECT_TRUE(isFinite(state));
  state.gyroscope_bias.z() = std::nan("");
  EXPECT_FALSE(isFinite(state));
}

TEST(WindowState, KeepsItsFirstEstimateOnceFixed) {
  testing::Random random(3);
  const NavState first = random.navState();
  const NavState second = random.navState();
  const NavState third = random.navState();
  WindowState state(first);
  state.setValue(second);
  EXPECT_EQ(state.poseForJacobians(third.T_wb).position, third.T_wb.position);
  state.fixPose();
  state.setValue(third);
  state.fixPose();
  EXPECT_TRUE(state.isPoseFixed());
  EXPECT_FALSE(state.isMotionFixed());
  EXPECT_EQ(state.poseForJacobians(third.T_wb).position, second.T_wb.position);
  EXPECT_EQ(state.motionForJacobians(first).v_w, first.v_w);
  state.fixMotion();
  EXPECT_EQ(state.motionForJacobians(first).v_w, third.v_w);
}

}  // namespace
}  // namespace vins::estimator
