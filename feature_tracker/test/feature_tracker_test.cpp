#include "feature_tracker/feature_tracker.h"

#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "camera_model/testing/example_cameras.h"
#include "plane_world.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::feature_tracker {
namespace {

constexpr Stamp kPeriod = 50'000'000;

Pose swayingPose(int i) {
  const double t = 0.05 * i;
  return {so3::exp({0.05 * std::sin(t), 0.08 * std::sin(0.7 * t), 0.1 * std::sin(0.5 * t)}),
          {0.4 * std::sin(0.8 * t), 0.3 * std::sin(0.6 * t), 0.2 * std::sin(0.5 * t)}};
}

/// Images of a swaying camera, rendered once for all tests.
const std::vector<cv::Mat>& swayingImages() {
  static const std::vector<cv::Mat> images = [] {
    const testing::PlaneWorld world(vins::camera_model::testing::exampleCameras().front());
    std::vector<cv::Mat> rendered;
    for (int i = 0; i < 30; ++i) rendered.push_back(world.render(swayingPose(i)));
    return rendered;
  }();
  return images;
}

FeatureTracker makeTracker(const FeatureTrackerOptions& options = {}, const cv::Mat& mask = {}) {
  return FeatureTracker({vins::camera_model::testing::exampleCameras().front()}, {Pose()}, options,
                        mask);
}

FeatureTrackerResult step(FeatureTracker* tracker, int i) {
  return tracker->track({swayingImages()[i]}, kPeriod * (i + 1), {});
}

bool hasEvent(const FeatureTrackerResult& result, const std::string& code) {
  for (const Event& event : result.events) {
    if (event.code == code) return true;
  }
  return false;
}

TEST(FeatureTracker, FollowsTheTruthAndFillsEveryField) {
  const testing::PlaneWorld world(vins::camera_model::testing::exampleCameras().front());
  FeatureTracker tracker = makeTracker();
  std::map<std::int64_t, Eigen::Vector3d> points, bearings;
  for (int i = 0; i < 30; ++i) {
    const auto result = step(&tracker, i);
    ASSERT_TRUE(result.frame);
    EXPECT_EQ(result.frame->sequence, static_cast<std::uint32_t>(i));
    EXPECT_EQ(result.frame->stamp, kPeriod * (i + 1));
    EXPECT_GT(result.frame->observations.size(), 100U);
    for (const auto& observation : result.frame->observations) {
      EXPECT_NEAR(observation.bearing.norm(), 1.0, 1e-9);
      EXPECT_NEAR(observation.angular_resolution, 1.0 / 460.0, 1e-3);
      if (observation.track_length == 1) {
        EXPECT_EQ(points.count(observation.id), 0U) << "an id is used again";
        EXPECT_EQ(observation.bearing_velocity, Eigen::Vector3d::Zero().eval());
        points[observation.id] = *world.pointAt(swayingPose(i), observation.pixel);
      } else {
        const Eigen::Vector3d velocity = (observation.bearing - bearings[observation.id]) / 0.05;
        EXPECT_LT((observation.bearing_velocity - velocity).norm(), 1e-9);
        const auto pixel = world.project(swayingPose(i), points[observation.id]);
        EXPECT_LT((observation.pixel - *pixel).norm(), 1.0);
      }
      bearings[observation.id] = observation.bearing;
    }
  }
}

TEST(FeatureTracker, IsTheSameBitForBit) {
  FeatureTracker a = makeTracker(), b = makeTracker();
  for (int i = 0; i < 15; ++i) {
    const auto first = step(&a, i), second = step(&b, i);
    ASSERT_EQ(first.frame->observations.size(), second.frame->observations.size());
    for (std::size_t k = 0; k < first.frame->observations.size(); ++k) {
      EXPECT_EQ(first.frame->observations[k].id, second.frame->observations[k].id);
      EXPECT_EQ(first.frame->observations[k].pixel, second.frame->observations[k].pixel);
      EXPECT_EQ(first.frame->observations[k].bearing, second.frame->observations[k].bearing);
    }
  }
}

TEST(FeatureTracker, HandsOutAtTheRateThatIsAskedFor) {
  FeatureTrackerOptions options;
  options.frequency = 10.0;
  FeatureTracker tracker = makeTracker(options);
  int frames = 0, longest = 0;
  for (int i = 0; i < 20; ++i) {
    const auto result = step(&tracker, i);
    if (!result.frame) continue;
    ++frames;
    for (const auto& observation : result.frame->observations) {
      longest = std::max(longest, observation.track_length);
    }
  }
  EXPECT_EQ(frames, 10);
  EXPECT_GE(longest, 19);  // tracking runs on every image
}

TEST(FeatureTracker, HonoursTheMask) {
  cv::Mat mask(480, 752, CV_8U, cv::Scalar(255));
  mask(cv::Rect(0, 0, 376, 480)).setTo(0);
  FeatureTracker tracker = makeTracker({}, mask);
  for (int i = 0; i < 10; ++i) {
    const auto result = step(&tracker, i);
    for (const auto& observation : result.frame->observations) {
      EXPECT_GE(observation.pixel.x(), 375.0);
    }
  }
}

TEST(FeatureTracker, SurvivesAStepOfTheGain) {
  FeatureTracker tracker = makeTracker();
  for (int i = 0; i < 5; ++i) step(&tracker, i);
  cv::Mat darker;
  swayingImages()[5].convertTo(darker, CV_8U, 0.6);
  const auto result = tracker.track({darker}, kPeriod * 6, {});
  EXPECT_GT(result.statistics.inliers, result.statistics.before * 85 / 100);
}

TEST(FeatureTracker, StartsAgainWhenTimeJumpsBack) {
  constexpr Stamp kBegin = 10'000'000'000;
  FeatureTracker tracker = makeTracker();
  std::set<std::int64_t> ids;
  for (int i = 0; i < 5; ++i) {
    const auto result = tracker.track({swayingImages()[i]}, kBegin + kPeriod * i, {});
    for (const auto& observation : result.frame->observations) ids.insert(observation.id);
  }
  const auto back = tracker.track({swayingImages()[5]}, kPeriod, {});
  EXPECT_TRUE(back.restarted);
  EXPECT_TRUE(hasEvent(back, "tracker_restarted"));
  for (const auto& observation : back.frame->observations) {
    EXPECT_EQ(observation.track_length, 1);
    EXPECT_EQ(ids.count(observation.id), 0U);
  }
}

TEST(FeatureTracker, ALateImageCostsThatImageOnly) {
  FeatureTracker tracker = makeTracker();
  FeatureTracker undisturbed = makeTracker();
  for (int i = 0; i < 5; ++i) {
    step(&tracker, i);
    step(&undisturbed, i);
  }
  const auto late = tracker.track({swayingImages()[1]}, kPeriod * 5 - kPeriod / 2, {});
  EXPECT_FALSE(late.frame.has_value());
  EXPECT_FALSE(late.restarted);
  EXPECT_TRUE(hasEvent(late, "image_late"));
  const auto next = step(&tracker, 5);
  const auto expected = step(&undisturbed, 5);
  ASSERT_TRUE(next.frame.has_value());
  EXPECT_EQ(next.statistics.inliers, expected.statistics.inliers);
  EXPECT_EQ(next.frame->observations.size(), expected.frame->observations.size());
}

TEST(FeatureTracker, APauseOfImagesBeginsNewTracksWithoutARestart) {
  FeatureTracker tracker = makeTracker();
  for (int i = 0; i < 5; ++i) step(&tracker, i);
  const auto gap = tracker.track({swayingImages()[6]}, kPeriod + 5'000'000'000, {});
  EXPECT_FALSE(gap.restarted);
  EXPECT_TRUE(hasEvent(gap, "image_gap"));
  ASSERT_TRUE(gap.frame.has_value());
  for (const auto& observation : gap.frame->observations) EXPECT_EQ(observation.track_length, 1);
}

/// An image as a camera has it at dusk: dark, all grey values within a few, and noisy.
cv::Mat atDusk(const cv::Mat& image) {
  cv::Mat1f noise(image.size());
  cv::RNG random(static_cast<std::uint64_t>(image.at<uchar>(100, 100)) + 1);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 1.5);
  cv::Mat1f dark;
  image.convertTo(dark, CV_32F, 0.2, 0.0);
  cv::Mat result;
  cv::Mat(dark + noise).convertTo(result, CV_8U);
  return result;
}

TEST(FeatureTracker, EqualizesWhatIsTooDullToTrack) {
  FeatureTrackerOptions options;
  FeatureTracker plain = makeTracker(options);
  options.equalization = Equalization::kWhereDull;
  FeatureTracker equalizing = makeTracker(options);
  FeatureTrackerResult by_plain, by_equalizing;
  for (int i = 0; i < 12; ++i) {
    const cv::Mat image = atDusk(swayingImages()[i]);
    by_plain = plain.track({image}, kPeriod * (i + 1), {});
    by_equalizing = equalizing.track({image}, kPeriod * (i + 1), {});
    EXPECT_FALSE(by_plain.statistics.equalized);
    EXPECT_TRUE(by_equalizing.statistics.equalized);
  }
  // Most of the cells have a track again, and most tracks last; without, there are hardly any.
  EXPECT_GT(by_equalizing.frame->observations.size(), 90U);
  EXPECT_GT(by_equalizing.statistics.inliers, 80);
  EXPECT_LT(by_plain.frame->observations.size(), by_equalizing.frame->observations.size() / 2);
}

/// A wall in an even light: contrasts of some grey values, hardly any noise.
cv::Mat faint(const cv::Mat& image) {
  cv::Mat result;
  image.convertTo(result, CV_8U, 0.06, 110.0);
  return result;
}

TEST(FeatureTracker, FollowsFaintStructureWhereThereIsNoNoise) {
  FeatureTracker tracker = makeTracker();
  FeatureTrackerResult result;
  for (int i = 0; i < 12; ++i) {
    result = tracker.track({faint(swayingImages()[i])}, kPeriod * (i + 1), {});
  }
  EXPECT_GT(result.frame->observations.size(), 75U) << "half of those wanted";
  EXPECT_GT(result.statistics.inliers, 0.8 * result.statistics.before);
}

TEST(FeatureTracker, KeepsItsTracksWhereEqualizingBeginsAndEnds) {
  FeatureTrackerOptions options;
  options.equalization = Equalization::kWhereDull;
  FeatureTracker tracker = makeTracker(options);
  bool was_equalized = false;
  int changes = 0;
  for (int i = 0; i < 30; ++i) {
    // Mist comes and goes again: contrasts fall from twice the images' own to half of it.
    const double contrast = std::exp2(std::cos(2.0 * M_PI * i / 30.0));
    cv::Mat image;
    swayingImages()[i].convertTo(image, CV_8U, contrast, 120.0 * (1.0 - contrast));
    const auto result = tracker.track({image}, kPeriod * (i + 1), {});
    if (result.statistics.equalized != was_equalized) ++changes;
    was_equalized = result.statistics.equalized;
    // Both images of a pair are treated alike, so a change costs no more than other images do.
    if (i > 0) {
      EXPECT_GT(result.statistics.inliers, 0.8 * result.statistics.before) << i;
    }
  }
  EXPECT_EQ(changes, 2);
}

TEST(FeatureTracker, ReportsABlackoutAndItsEnd) {
  FeatureTracker tracker = makeTracker();
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(step(&tracker, i).events.empty());
  const auto dark = tracker.track({cv::Mat::zeros(480, 752, CV_8U)}, kPeriod * 4, {});
  EXPECT_TRUE(hasEvent(dark, "tracking_lost"));
  ASSERT_TRUE(dark.frame);
  EXPECT_TRUE(dark.frame->observations.empty());
  EXPECT_FALSE(hasEvent(step(&tracker, 4), "tracking_lost"));  // said once
  EXPECT_TRUE(hasEvent(step(&tracker, 5), "tracking_resumed"));
}

TEST(FeatureTracker, RefusesBadImagesWithAWord) {
  FeatureTracker tracker = makeTracker();
  step(&tracker, 0);
  const std::vector<std::vector<cv::Mat>> bad = {{},
                                                 {cv::Mat()},
                                                 {cv::Mat::zeros(100, 752, CV_8U)},
                                                 {cv::Mat::zeros(480, 752, CV_16U)},
                                                 {cv::Mat::zeros(480, 752, CV_8UC3)}};
  for (const auto& images : bad) {
    const auto result = tracker.track(images, kPeriod * 2, {});
    EXPECT_FALSE(result.frame);
    ASSERT_TRUE(hasEvent(result, "image_refused"));
  }
  const auto small = tracker.track(bad[2], kPeriod * 2, {});
  EXPECT_NE(small.events[0].text.find("752x100"), std::string::npos);
  EXPECT_NE(small.events[0].text.find("752x480"), std::string::npos);
  for (const Stamp stamp : {kPeriod, Stamp{-1}, std::numeric_limits<Stamp>::min()}) {
    EXPECT_TRUE(hasEvent(tracker.track({swayingImages()[1]}, stamp, {}), "image_refused"));
  }
  EXPECT_GT(tracker.track({swayingImages()[1]}, kPeriod * 2, {}).statistics.inliers, 100);
}

TEST(FeatureTracker, NeverCrashesOnFuzz) {
  FeatureTrackerOptions options;
  options.equalization = Equalization::kWhereDull;
  FeatureTracker tracker = makeTracker(options);
  cv::RNG random(3);
  Stamp stamp = kPeriod;
  for (int i = 0; i < 120; ++i) {
    cv::Mat image(480, 752, CV_8U, cv::Scalar(i % 3 == 0 ? 0 : 255));
    if (i % 4 == 1) random.fill(image, cv::RNG::UNIFORM, 0, 256);
    if (i % 4 == 2) image = swayingImages()[i % 30];
    if (i % 7 == 0) image = image(cv::Rect(0, 0, 100 + i, 7)).clone();
    stamp += random.uniform(-1, 4) * kPeriod;
    ImuSample sample{stamp, Eigen::Vector3d::Zero(),
                     Eigen::Vector3d::Constant(i % 5 == 0 ? std::nan("") : 1e3 * (i % 6))};
    EXPECT_NO_THROW(tracker.track({image}, i % 11 == 0 ? -stamp : stamp, {sample}));
  }
}

TEST(FeatureTracker, RefusesWhatItCannotBeMadeFrom) {
  const auto camera = vins::camera_model::testing::exampleCameras().front();
  EXPECT_THROW(FeatureTracker({}, {}, {}), InputError);
  EXPECT_THROW(FeatureTracker({camera}, {}, {}), InputError);
  EXPECT_THROW(FeatureTracker({camera}, {Pose()}, {}, cv::Mat::zeros(9, 9, CV_8U)), InputError);
}

}  // namespace
}  // namespace vins::feature_tracker
