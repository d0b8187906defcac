#include "camera_model/chessboard.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

constexpr int kMargin = 60;
constexpr int kSquare = 40;

/// A board seen straight on, corners between pixels, blurred like an image.
cv::Mat drawBoard(const Chessboard& board) {
  const int factor = 4;
  const cv::Size size((board.columns + 1) * kSquare + 2 * kMargin,
                      (board.rows + 1) * kSquare + 2 * kMargin);
  cv::Mat large(size * factor, CV_8UC1, cv::Scalar(230));
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = row % 2; column <= board.columns; column += 2) {
      const cv::Rect square(kMargin + column * kSquare, kMargin + row * kSquare, kSquare, kSquare);
      cv::rectangle(large, cv::Rect(square.tl() * factor, square.size() * factor), cv::Scalar(20),
                    cv::FILLED);
    }
  }
  cv::Mat image;
  cv::resize(large, image, size, 0.0, 0.0, cv::INTER_AREA);
  cv::GaussianBlur(image, image, {0, 0}, 0.8);
  return image;
}

TEST(Chessboard, CornersAreFoundToATenthOfAPixel) {
  const Chessboard board{9, 6, 0.03};
  const auto corners = detectChessboard(drawBoard(board), board);
  ASSERT_TRUE(corners);
  ASSERT_EQ(corners->size(), 54u);
  // Either end of the board may come first.
  const bool turned = corners->front().x() > corners->back().x();
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 9; ++column) {
      const auto i = static_cast<std::size_t>(row * 9 + column);
      const Eigen::Vector2d& found = corners->at(turned ? 53 - i : i);
      // Pixel (0, 0) is a pixel's centre: the edge between two pixels lies at one half.
      const Eigen::Vector2d expected(kMargin + (column + 1) * kSquare - 0.5,
                                     kMargin + (row + 1) * kSquare - 0.5);
      EXPECT_LT((found - expected).norm(), 0.1);
    }
  }
}

TEST(Chessboard, NothingIsFoundWhereThereIsNone) {
  EXPECT_FALSE(detectChessboard(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), {9, 6, 1.0}));
  cv::Mat noise(240, 320, CV_8UC1);
  cv::RNG random(3);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  EXPECT_FALSE(detectChessboard(noise, {9, 6, 1.0}));
}

TEST(Chessboard, PointsAreRowByRow) {
  const auto points = Chessboard{3, 4, 0.5}.points();
  ASSERT_EQ(points.size(), 12u);
  EXPECT_EQ(points[1], Eigen::Vector3d(0.5, 0.0, 0.0));
  EXPECT_EQ(points[3], Eigen::Vector3d(0.0, 0.5, 0.0));
}

TEST(Chessboard, RefusesWhatIsNoBoard) {
  EXPECT_THROW((Chessboard{2, 6, 1.0}.validate()), InputError);
  EXPECT_THROW((Chessboard{9, 6, 0.0}.validate()), InputError);
  EXPECT_THROW((Chessboard{9, 6, std::nan("")}.validate()), InputError);
  EXPECT_NO_THROW((Chessboard{9, 6, 1.0}.validate()));
}

}  // namespace
}  // namespace vins::camera_model
