#include "feature_tracker/stereo_matcher.h"

#include <gtest/gtest.h>

#include "camera_model/testing/example_cameras.h"
#include "feature_tracker/feature_tracker.h"
#include "plane_world.h"
#include "vins_core/so3.h"

namespace vins::feature_tracker {
namespace {

TEST(StereoMatcher, SeesTheSamePointsByBothCameras) {
  const auto camera = vins::camera_model::testing::exampleCameras().front();
  const testing::PlaneWorld world(camera, 3.0);
  const Pose T_b0, T_b1(so3::exp({0.01, 0.02, -0.01}), {0.11, 0.002, -0.001});
  FeatureTracker tracker({camera, camera}, {T_b0, T_b1}, {});
  for (int i = 0; i < 4; ++i) {
    const Pose T_wb(Eigen::Quaterniond::Identity(), {0.01 * i, 0.0, 0.0});
    const auto result =
        tracker.track({world.render(T_wb), world.render(T_wb * T_b1)}, 50'000'000 * (i + 1), {});
    ASSERT_TRUE(result.frame);
    EXPECT_GT(result.statistics.stereo, 90);
    std::map<std::int64_t, Eigen::Vector2d> first;
    for (const auto& observation : result.frame->observations) {
      if (observation.camera == 0) first[observation.id] = observation.pixel;
      if (observation.camera != 1) continue;
      ASSERT_EQ(first.count(observation.id), 1U);
      const auto p_w = world.pointAt(T_wb, first[observation.id]);
      const auto expected = world.project(T_wb * T_b1, *p_w);
      EXPECT_LT((observation.pixel - *expected).norm(), 1.0);
      EXPECT_LE(observation.track_length, i + 1);
    }
  }
}

TEST(StereoMatcher, GoesOnWithOneEye) {
  const auto camera = vins::camera_model::testing::exampleCameras().front();
  const testing::PlaneWorld world(camera, 3.0);
  FeatureTracker tracker({camera, camera}, {Pose(), Pose({1, 0, 0, 0}, {0.1, 0, 0})}, {});
  const cv::Mat image = world.render(Pose());
  EXPECT_EQ(tracker.track({image}, 50'000'000, {}).statistics.stereo, 0);
  EXPECT_EQ(tracker.track({image, cv::Mat()}, 100'000'000, {}).statistics.stereo, 0);
  const auto refused = tracker.track({image, cv::Mat::zeros(9, 9, CV_8U)}, 150'000'000, {});
  ASSERT_EQ(refused.events.size(), 1U);
  EXPECT_EQ(refused.events[0].code, "image_refused");
  EXPECT_TRUE(refused.frame);
}

}  // namespace
}  // namespace vins::feature_tracker
