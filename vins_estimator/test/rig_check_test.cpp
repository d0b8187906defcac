#include "vins_estimator/health/rig_check.h"

#include <string>

#include <gtest/gtest.h>

namespace vins::estimator {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr Stamp kSecond = 1'000'000'000;

RigCheckOptions options() {
  RigCheckOptions result;
  result.suspects = {RigPart::kTranslation, RigPart::kRotation, RigPart::kTimeOffset,
                     RigPart::kReadout, RigPart::kFocalLength};
  return result;
}

/// Of a window in which an error shows clearly: deviations of 0.1 of what RigCheckOptions reports.
/// `rest` of the cost is explained by nothing.
RigScore scoreOf(const RigErrorVector& error, double rest = 100.0) {
  RigErrorVector deviation;
  deviation << 0.003, 0.003, 0.003, 9e-4, 9e-4, 9e-4, 5e-4, 3e-4, 1e-3;
  RigScore score;
  score.information = deviation.cwiseAbs2().cwiseInverse().asDiagonal();
  score.gradient = -score.information * error;
  score.cost = rest + 0.5 * error.dot(score.information * error);
  return score;
}

RigErrorVector rotationBy(double x, double y, double z) {
  RigErrorVector error = RigErrorVector::Zero();
  error.segment<3>(3) << x * kDegree, y * kDegree, z * kDegree;
  return error;
}

RigErrorVector single(int index, double value) {
  RigErrorVector error = RigErrorVector::Zero();
  error(index) = value;
  return error;
}

/// Shows a check windows of five seconds and collects its events.
struct Session {
  explicit Session(const RigCheckOptions& check_options = options()) : check(check_options) {
    check.begin(0);
  }

  void show(const RigScore& score, int windows) {
    for (int i = 0; i < windows; ++i) {
      newest += 5 * kSecond;
      const std::optional<Event> event = check.addScore(newest, score);
      if (event) events.push_back(*event);
    }
  }

  RigCheck check;
  Stamp newest = 0;
  std::vector<Event> events;
};

TEST(RigCheck, ReportsAWrongRotationOnce) {
  Session session;
  session.show(scoreOf(rotationBy(0.95, 0.1, 0.0)), 3);
  EXPECT_TRUE(session.events.empty()) << "three windows are too few";
  session.show(scoreOf(rotationBy(0.95, 0.1, 0.0)), 10);
  ASSERT_EQ(session.events.size(), 1u);
  const Event& event = session.events.front();
  EXPECT_EQ(event.code, "rig_rotation");
  EXPECT_EQ(event.severity, Severity::kWarning);
  EXPECT_NE(event.text.find("at least 0.9 degrees about its x axis"), std::string::npos)
      << event.text;
  EXPECT_NE(event.text.find("estimate_extrinsic: 1"), std::string::npos) << event.text;
  EXPECT_EQ(session.check.verdict(), RigPart::kRotation);
}

TEST(RigCheck, NamesEachPartAndItsSign) {
  const struct {
    RigErrorVector error;
    const char* code;
    const char* words;
  } cases[] = {
      {single(2, 0.06), "rig_translation", "(0, 0, 0.06) m in the body frame"},
      {rotationBy(1.0, 1.0, 0.0), "rig_rotation", "about its axis (0.71, 0.71, 0)"},
      {single(6, 0.02), "rig_time_offset", "ms larger than it is given"},
      {single(6, -0.02), "rig_time_offset", "ms smaller than it is given"},
      {single(7, 0.02), "rig_readout", "ms more to be read out"},
      {single(7, -0.02), "rig_readout", "ms less to be read out"},
      {single(8, 0.03), "rig_focal_length", "% larger than"},
      {single(8, -0.03), "rig_focal_length", "% smaller than"},
  };
  for (const auto& wrong : cases) {
    Session session;
    session.show(scoreOf(wrong.error), 4);
    ASSERT_EQ(session.events.size(), 1u) << wrong.code;
    EXPECT_EQ(session.events.front().code, wrong.code);
    EXPECT_NE(session.events.front().text.find(wrong.words), std::string::npos)
        << session.events.front().text;
  }
}

TEST(RigCheck, IsSilentAboutSmallErrors) {
  Session session;
  session.show(scoreOf(rotationBy(0.4, 0.0, 0.0)), 20);
  EXPECT_TRUE(session.events.empty()) << "below half a degree";
  // Clear, but next to nothing of what is unexplained: something else is wrong.
  session.show(scoreOf(rotationBy(1.0, 0.0, 0.0), 1e5), 60);
  EXPECT_TRUE(session.events.empty()) << session.events.front().text;
}

TEST(RigCheck, IsSilentWhereWindowsContradictEachOther) {
  Session session;
  for (int i = 0; i < 10; ++i) {
    session.show(scoreOf(rotationBy(4.0, 0.0, 0.0)), 1);
    session.show(scoreOf(rotationBy(-2.5, 0.0, 0.0)), 1);
  }
  EXPECT_TRUE(session.events.empty()) << session.events.front().text;
}

TEST(RigCheck, IsSilentWhereTwoPartsExplainItAlike) {
  // In straight flight at one height the two cannot be told apart.
  RigScore score = scoreOf(single(6, 0.02));
  score.information(6, 7) = score.information(7, 6) =
      0.95 * std::sqrt(score.information(6, 6) * score.information(7, 7));
  score.gradient = -score.information * single(6, 0.02);
  Session session;
  session.show(score, 20);
  EXPECT_TRUE(session.events.empty()) << session.events.front().text;
}

TEST(RigCheck, DoesNotSuspectWhatIsEstimated) {
  RigCheckOptions refined;
  refined.suspects = {RigPart::kReadout, RigPart::kFocalLength};
  refined.estimated = {RigPart::kTranslation, RigPart::kRotation, RigPart::kTimeOffset};
  // What looks like a wrong focal length is the rotation's, which is being refined.
  RigScore score = scoreOf(RigErrorVector::Zero());
  score.information(3, 8) = score.information(8, 3) =
      0.8 * std::sqrt(score.information(3, 3) * score.information(8, 8));
  score.gradient = -score.information * rotationBy(2.0, 0.0, 0.0);
  Session trusting;
  trusting.show(score, 10);
  EXPECT_FALSE(trusting.events.empty());
  Session refining(refined);
  refining.show(score, 10);
  EXPECT_TRUE(refining.events.empty()) << refining.events.front().text;
}

TEST(RigCheck, TakesItsVerdictBackAndChangesIt) {
  RigCheckOptions forgetful = options();
  forgetful.max_windows = 10;
  Session session(forgetful);
  session.show(scoreOf(rotationBy(1.0, 0.0, 0.0)), 10);
  session.show(scoreOf(RigErrorVector::Zero()), 4);
  EXPECT_EQ(session.events.size(), 1u) << "0.6 degrees are left of it: no news";
  session.show(scoreOf(RigErrorVector::Zero()), 10);
  ASSERT_EQ(session.events.size(), 2u);
  EXPECT_EQ(session.events.back().code, "rig_agrees");
  session.show(scoreOf(single(8, 0.05)), 10);
  ASSERT_EQ(session.events.size(), 3u);
  EXPECT_EQ(session.events.back().code, "rig_focal_length");
}

TEST(RigCheck, AsksForWindowsThatDoNotOverlap) {
  RigCheck check(options());
  EXPECT_FALSE(check.isDue(100 * kSecond)) << "nothing has begun";
  check.begin(100 * kSecond);
  EXPECT_FALSE(check.isDue(102 * kSecond));
  EXPECT_TRUE(check.isDue(104 * kSecond));
  check.addScore(110 * kSecond, RigScore());
  EXPECT_FALSE(check.isDue(109 * kSecond));
  EXPECT_TRUE(check.isDue(110 * kSecond));
  check.clear();
  EXPECT_FALSE(check.isDue(120 * kSecond));
}

}  // namespace
}  // namespace vins::estimator
