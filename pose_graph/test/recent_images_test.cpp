#include "pose_graph/place/recent_images.h"

#include <memory>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace vins::pose_graph {
namespace {

constexpr Stamp kMs = 1'000'000;

cv::Mat imageOf(int value) { return cv::Mat1b(1, 1, static_cast<uchar>(value)); }

TEST(RecentImages, FindsTheNearestAndForgetsTheOldest) {
  RecentImages<cv::Mat> images(0.1);
  for (int i = 0; i < 5; ++i) images.add(i * 50 * kMs, imageOf(i));
  EXPECT_EQ(images.size(), 3u);
  EXPECT_TRUE(images.find(50 * kMs).empty()) << "forgotten";
  EXPECT_EQ(images.find(100 * kMs).at<uchar>(0), 2);
  EXPECT_EQ(images.find(204 * kMs).at<uchar>(0), 4) << "moved by a little";
  EXPECT_TRUE(images.find(225 * kMs).empty()) << "between two: neither";
}

TEST(RecentImages, TakesTheNearerOfTwoThatAreClose) {
  RecentImages<cv::Mat> images(0.1);
  images.add(0, imageOf(0));
  images.add(6 * kMs, imageOf(1));
  EXPECT_EQ(images.find(2 * kMs).at<uchar>(0), 0);
  EXPECT_EQ(images.find(4 * kMs).at<uchar>(0), 1);
}

TEST(RecentImages, ARestartedRecordingBeginsAnew) {
  RecentImages<cv::Mat> images(0.1);
  images.add(1000 * kMs, imageOf(0));
  images.add(600 * kMs, imageOf(2));
  EXPECT_TRUE(images.find(600 * kMs).empty()) << "late: left out";
  EXPECT_FALSE(images.find(1000 * kMs).empty());
  images.add(0, imageOf(1));
  EXPECT_EQ(images.size(), 1u);
  EXPECT_TRUE(images.find(1000 * kMs).empty());
}

TEST(RecentImages, KeepsAHandleAndLetsGoOfIt) {
  RecentImages<std::shared_ptr<const int>> images(0.1);
  const auto message = std::make_shared<const int>(7);
  images.add(0, message);
  EXPECT_EQ(images.find(4 * kMs).get(), message.get()) << "the message itself, not a copy";
  EXPECT_EQ(images.find(6 * kMs), nullptr);
  images.add(150 * kMs, std::make_shared<const int>(8));
  EXPECT_EQ(message.use_count(), 1) << "forgotten";
}

}  // namespace
}  // namespace vins::pose_graph
