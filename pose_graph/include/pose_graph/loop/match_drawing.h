#pragma once

#include <opencv2/core.hpp>

#include "pose_graph/loop/loop_verifier.h"

namespace vins::pose_graph {

/// A picture for people: the query's image (left) and the old one (right), each CV_8UC1 or CV_8UC3,
/// with the matches as lines, inliers green and others red, above a line of text with ids, the
/// score of the place recognition, inliers and verdict. CV_8UC3. The views must be those of the
/// verification.
cv::Mat drawMatches(const cv::Mat& query_image, const cv::Mat& old_image, const KeyframeView& query,
                    const KeyframeView& old, const LoopVerification& verification, double score);

}  // namespace vins::pose_graph
