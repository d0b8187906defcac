#include "pose_graph/loop/match_drawing.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include <opencv2/imgproc.hpp>

namespace vins::pose_graph {
namespace {

constexpr int kGap = 8;       // between the images [px]
constexpr int kTextRow = 26;  // [px]
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
const cv::Scalar kInlier(60, 200, 60);
const cv::Scalar kOutlier(60, 60, 220);

void paste(const cv::Mat& image, const cv::Point& at, cv::Mat* picture) {
  cv::Mat part = (*picture)(cv::Rect(at, image.size()));
  if (image.channels() == 1) {
    cv::cvtColor(image, part, cv::COLOR_GRAY2BGR);
  } else {
    image.copyTo(part);
  }
}

cv::Point pixelOf(const ViewFeature& feature, int left) {
  return {static_cast<int>(std::lround(feature.pixel.x())) + left,
          static_cast<int>(std::lround(feature.pixel.y()))};
}

void drawLines(const KeyframeView& query, const KeyframeView& old,
               const LoopVerification& verification, bool inliers, int left, cv::Mat* picture) {
  const cv::Scalar& colour = inliers ? kInlier : kOutlier;
  for (std::size_t i = 0; i < verification.matches.size(); ++i) {
    if ((verification.is_inlier[i] != 0) != inliers) continue;
    const cv::Point from = pixelOf(query.features[verification.matches[i].query], 0);
    const cv::Point to = pixelOf(old.features[verification.matches[i].old], left);
    cv::line(*picture, from, to, colour, 1, cv::LINE_AA);
    cv::circle(*picture, from, 3, colour, 1, cv::LINE_AA);
    cv::circle(*picture, to, 3, colour, 1, cv::LINE_AA);
  }
}

}  // namespace

cv::Mat drawMatches(const cv::Mat& query_image, const cv::Mat& old_image, const KeyframeView& query,
                    const KeyframeView& old, const LoopVerification& verification, double score) {
  const int left = query_image.cols + kGap;
  const int height = std::max(query_image.rows, old_image.rows);
  cv::Mat picture(height + kTextRow, left + old_image.cols, CV_8UC3, cv::Scalar::all(255));
  paste(query_image, {0, 0}, &picture);
  paste(old_image, {left, 0}, &picture);
  drawLines(query, old, verification, false, left, &picture);
  drawLines(query, old, verification, true, left, &picture);
  std::ostringstream text;
  text << verification.describe() << std::fixed << std::setprecision(3) << ", score " << score;
  const double scale = picture.cols / 1512.0 * 0.6;
  cv::putText(picture, text.str(), {6, picture.rows - 8}, kFont, scale, cv::Scalar::all(0), 1,
              cv::LINE_AA);
  return picture;
}

}  // namespace vins::pose_graph
