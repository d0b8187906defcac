#include "pose_graph/place/spread_corners.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "textured_image.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using testing::texturedImage;

TEST(SpreadCorners, AreManyAndEverywhere) {
  const auto corners = findSpreadCorners(texturedImage(752, 480, 1), {}, {});
  EXPECT_LE(corners.size(), 500u);
  EXPECT_GE(corners.size(), 400u);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      const cv::Rect2f part(24 + 176.0F * column, 24 + 144.0F * row, 176, 144);
      const auto inside = [&part](const cv::Point2f& corner) { return part.contains(corner); };
      // A twelfth of them would be 40; cells that lie across parts move some.
      EXPECT_GE(std::count_if(corners.begin(), corners.end(), inside), 20);
    }
  }
}

TEST(SpreadCorners, KeepFromTheEdgeAndFromWhatIsTaken) {
  SpreadCornersOptions options;
  options.border = 60;
  options.min_distance = 15.0;
  std::vector<cv::Point2f> taken;
  for (int i = 0; i < 50; ++i) taken.emplace_back(80.4F + 12 * i, 70.7F + 7 * i);
  const auto corners = findSpreadCorners(texturedImage(752, 480, 1), taken, options);
  ASSERT_GT(corners.size(), 100u);
  for (const cv::Point2f& corner : corners) {
    EXPECT_TRUE(cv::Rect2f(60, 60, 752 - 120, 480 - 120).contains(corner));
    for (const cv::Point2f& other : taken) {
      // Discs are drawn about whole pixels: less than one is lost.
      EXPECT_GT(cv::norm(corner - other), 14.0);
    }
  }
}

TEST(SpreadCorners, AreNoneWhereNothingIs) {
  EXPECT_TRUE(findSpreadCorners(cv::Mat1b(480, 752, 99), {}, {}).empty());
  EXPECT_TRUE(findSpreadCorners(texturedImage(40, 40, 1), {}, {}).empty());
  SpreadCornersOptions none;
  none.max_corners = 0;
  EXPECT_TRUE(findSpreadCorners(texturedImage(752, 480, 1), {}, none).empty());
}

TEST(SpreadCorners, RefuseBadInput) {
  EXPECT_THROW(findSpreadCorners(cv::Mat(480, 752, CV_16UC1), {}, {}), InputError);
  SpreadCornersOptions options;
  EXPECT_NO_THROW(options.validate());
  options.fast_threshold = 0;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vins::pose_graph
