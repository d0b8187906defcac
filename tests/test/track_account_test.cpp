#include "simulation/track_account.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "simulation/gftt_tracker.h"

namespace vins::simulation {
namespace {

TEST(TrackAccount, CountsTracksAndTheirLives) {
  TrackAccount account;
  account.add(0.0, {1, 2});
  account.add(0.1, {1, 3});
  account.add(0.2, {1, 3, 4});
  const TrackFigures all = account.figures(0.0, 1.0);
  EXPECT_EQ(all.images, 3U);
  EXPECT_DOUBLE_EQ(all.tracks, 7.0 / 3.0);
  EXPECT_DOUBLE_EQ(all.followed, 3.0 / 3.0);  // 1; 1 and 3
  EXPECT_DOUBLE_EQ(all.life, (3 + 1 + 2 + 1) / 4.0);
  EXPECT_DOUBLE_EQ(all.age, (1 + 1 + 2 + 1 + 3 + 2 + 1) / 7.0);
}

TEST(TrackAccount, ASpanHasTheTracksThatBeginInIt) {
  TrackAccount account;
  account.add(0.0, {1});
  account.add(1.0, {1, 2});
  account.add(2.0, {2});
  const TrackFigures second = account.figures(1.0, 2.0);
  EXPECT_EQ(second.images, 1U);
  EXPECT_DOUBLE_EQ(second.tracks, 2.0);
  EXPECT_DOUBLE_EQ(second.followed, 1.0);
  EXPECT_DOUBLE_EQ(second.life, 2.0) << "track 2, its image after the span included";
  EXPECT_DOUBLE_EQ(second.age, 1.5);
  EXPECT_EQ(account.figures(5.0, 6.0).images, 0U);
  EXPECT_EQ(account.figures(5.0, 6.0).life, 0.0);
}

TEST(GfttTracker, FollowsAShiftAndKeepsItsDistance) {
  cv::Mat image(360, 640, CV_8UC1, cv::Scalar(90));
  for (int y = 0; y < 9; ++y) {
    for (int x = y % 2; x < 16; x += 2) image(cv::Rect(40 * x, 40 * y, 40, 40)).setTo(170);
  }
  cv::Mat moved;
  const cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, 3, 0, 1, 2);
  cv::warpAffine(image, moved, shift, image.size());
  GfttTracker tracker({60, 30.0, 0.01});
  EXPECT_EQ(tracker.add(image), 0);
  const std::vector<GfttTrack> before = tracker.tracks();
  ASSERT_EQ(before.size(), 60U);
  ASSERT_GT(tracker.add(moved), 50);
  const GfttTrack& first = tracker.tracks().front();
  for (const GfttTrack& track : before) {
    if (track.id != first.id) continue;
    EXPECT_NEAR(first.pixel.x - track.pixel.x, 3.0, 0.1);
    EXPECT_NEAR(first.pixel.y - track.pixel.y, 2.0, 0.1);
  }
}

}  // namespace
}  // namespace vins::simulation
