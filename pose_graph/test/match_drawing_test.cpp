#include "pose_graph/loop/match_drawing.h"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "loop_scene.h"

namespace vins::pose_graph {
namespace {

int countColour(const cv::Mat& picture, bool green) {
  int count = 0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const auto& pixel = picture.at<cv::Vec3b>(y, x);
      count += pixel[green ? 1 : 2] > 150 && pixel[green ? 2 : 1] < 120 ? 1 : 0;
    }
  }
  return count;
}

TEST(DrawMatches, ShowsBothImagesInliersAndOutliers) {
  testing::LoopScene scene;
  scene.wrong = 30;
  const auto views = scene.views();
  const auto verification = LoopVerifier({}).verify(views.query, views.old);
  ASSERT_TRUE(verification.isAccepted());
  const cv::Mat grey(480, 752, CV_8UC1, cv::Scalar(77)), colour(480, 752, CV_8UC3, {30, 30, 30});
  const cv::Mat picture = drawMatches(grey, colour, views.query, views.old, verification, 0.1);
  ASSERT_EQ(picture.type(), CV_8UC3);
  EXPECT_GE(picture.cols, 2 * 752);
  EXPECT_GT(picture.rows, 480);
  EXPECT_EQ(picture.at<cv::Vec3b>(2, 2), cv::Vec3b(77, 77, 77));
  EXPECT_EQ(picture.at<cv::Vec3b>(2, picture.cols - 3), cv::Vec3b(30, 30, 30));
  EXPECT_GT(countColour(picture, true), 1000);
  EXPECT_GT(countColour(picture, false), 300);
  const cv::Mat text = picture.rowRange(482, picture.rows);
  cv::Mat dark;
  cv::inRange(text, cv::Scalar::all(0), cv::Scalar::all(100), dark);
  EXPECT_GT(cv::countNonZero(dark), 200);
}

TEST(DrawMatches, ServesRejectedLoopsAndImagesOfTwoSizes) {
  testing::LoopScene scene;
  scene.good = 0;
  scene.wrong = 60;
  const auto views = scene.views();
  const auto verification = LoopVerifier({}).verify(views.query, views.old);
  const cv::Mat picture = drawMatches(cv::Mat1b(480, 752, 50), cv::Mat1b(600, 800, 50), views.query,
                                      views.old, verification, 0.1);
  EXPECT_GE(picture.rows, 600);
  EXPECT_GT(countColour(picture, false), 300);
}

}  // namespace
}  // namespace vins::pose_graph
