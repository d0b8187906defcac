#include "vins_pipeline/input_account.h"

#include <string>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins::pipeline {
namespace {

constexpr Stamp kSecond = 1'000'000'000;

TEST(InputAccount, ARefusedImageIsCountedAndTold) {
  InputAccount account;
  account.addImage(1);
  for (int i = 0; i < 20; ++i) {
    const Event event = account.refuse(7, "no pixels");
    EXPECT_EQ(event.code, "image_refused");
    EXPECT_EQ(event.text, "no pixels");
    EXPECT_EQ(event.stamp, 7);
  }
  EXPECT_EQ(account.refused(), 20u);
  EXPECT_NO_THROW(account.requireImages());
}

TEST(InputAccount, NothingButRefusedImagesIsAnError) {
  InputAccount account;
  EXPECT_NO_THROW(account.requireImages());
  for (int i = 0; i < 9; ++i) account.refuse(i, "wrong size");
  EXPECT_THROW(account.requireImages(), InputError);
  EXPECT_THROW(account.refuse(9, "wrong size"), InputError);
}

TEST(InputAccount, KnowsWhenTheImuEnded) {
  InputAccount account;
  account.addImu(10 * kSecond);
  account.addImage(10 * kSecond + kSecond / 4);
  EXPECT_FALSE(account.imuEnd());
  account.addImage(12 * kSecond);
  EXPECT_EQ(account.imuEnd(), 10 * kSecond);
}

TEST(InputAccount, TheImuEndsWithTheFirstOfItsPartsToEnd) {
  InputAccount account;
  account.addImage(9 * kSecond);
  account.addAcceleration(10 * kSecond);
  account.addImu(12 * kSecond);
  account.addImage(12 * kSecond);
  EXPECT_EQ(account.imuEnd(), 10 * kSecond);
  account.addAcceleration(12 * kSecond);
  EXPECT_FALSE(account.imuEnd());
}

TEST(InputAccount, ClocksThatAreApartAreNoEnd) {
  InputAccount account;
  account.addImu(10 * kSecond);
  account.addImage(3600 * kSecond);
  account.addImage(3601 * kSecond);
  EXPECT_FALSE(account.imuEnd());
}

TEST(InputAccount, KeepsTheLastReasonOfEachKind) {
  InputAccount account;
  account.addEvents({{0, Severity::kWarning, "init_little_parallax", "old", {}},
                     {1, Severity::kWarning, "init_little_parallax", "new", {}},
                     {2, Severity::kWarning, "reset", "other", {}}});
  EXPECT_EQ(account.waitingReasons(), "  init_little_parallax: new\n");
}

TEST(InputAccount, SummarizesWhatIsWrongOfTheRigUntilThatIsTakenBack) {
  InputAccount account;
  EXPECT_EQ(account.problems({}), "");
  account.addEvents({{0, Severity::kWarning, "rig_focal_length", "the focal length", {}},
                     {1, Severity::kWarning, "rig_rotation", "the camera is turned", {}}});
  EXPECT_EQ(account.problems({}), "rig           the camera is turned\n");
  account.addEvents({{2, Severity::kInfo, "rig_agrees", "all is well", {}}});
  EXPECT_EQ(account.problems({}), "");
}

}  // namespace
}  // namespace vins::pipeline
