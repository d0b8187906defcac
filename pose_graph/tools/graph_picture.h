#pragma once

#include <opencv2/core.hpp>

#include "pose_graph/graph/relative_pose_graph.h"

namespace vins::pose_graph {

/// Two states of a graph side by side, each scaled to its own panel and seen along the direction in
/// which the second one is thinnest: edges between neighbours in the list of poses dark, all others
/// in a light colour.
cv::Mat drawGraphs(const RelativePoseGraph& before, const RelativePoseGraph& after);

}  // namespace vins::pose_graph
