#include "pose_graph/map/picture_store.h"

#include <gtest/gtest.h>

#include "textured_image.h"

namespace vins::pose_graph {
namespace {

TEST(PictureStore, GivesBackAnImageInItsSize) {
  PictureStore store(10);
  cv::Mat1b image(240, 376);
  for (int x = 0; x < image.cols; ++x) image.col(x).setTo(x / 2);
  store.add(3, image);
  const cv::Mat found = store.find(3, image.size());
  ASSERT_EQ(found.size(), image.size());
  // A smooth ramp: half the size and JPEG's coding change it by some grey values.
  EXPECT_LT(cv::norm(found, image, cv::NORM_INF), 8.0);
}

TEST(PictureStore, KeepsTheHighestIds) {
  PictureStore store(2);
  for (const std::int64_t id : {-7, 5, 6}) store.add(id, testing::texturedImage(40, 40, 1));
  EXPECT_EQ(store.size(), 2u);
  EXPECT_TRUE(store.encoded(-7).empty());
  EXPECT_FALSE(store.encoded(5).empty());
}

TEST(PictureStore, WhatIsNoImageIsBlack) {
  PictureStore store(5);
  store.addEncoded(1, {1, 2, 3, 4});
  store.addEncoded(2, {});
  EXPECT_EQ(store.size(), 1u) << "an empty one is none";
  EXPECT_EQ(cv::countNonZero(store.find(1, {40, 30})), 0);
  EXPECT_EQ(store.find(9, {40, 30}).size(), cv::Size(40, 30));
}

TEST(PictureStore, TravelsThroughAFileUnchanged) {
  PictureStore store(5), other(5);
  store.add(1, testing::texturedImage(80, 60, 1));
  other.addEncoded(-4, store.encoded(1));
  EXPECT_EQ(cv::norm(other.find(-4, {80, 60}), store.find(1, {80, 60}), cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace vins::pose_graph
