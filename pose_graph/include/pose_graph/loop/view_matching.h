#pragma once

#include <vector>

#include "pose_graph/place/keyframe_view.h"

namespace vins::pose_graph {

/// What matchViews() takes for a match.
struct MatchOptions {
  int max_distance = 80;   ///< bits in which two descriptors of a point differ at most
  double max_ratio = 0.9;  ///< of the best distance over the second best

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// A feature of the query and one of the old view, by their places in KeyframeView::features.
struct ViewMatch {
  int query = 0;
  int old = 0;
  int distance = 0;  ///< bits in which their descriptors differ
};

/// Matches the query's features that have a depth with all features of the old view, where they are
/// of the same node (the direct index). A match is the best one of either feature, and clearly
/// better than the query feature's second best. In the order of the query's features.
std::vector<ViewMatch> matchViews(const KeyframeView& query, const KeyframeView& old,
                                  const MatchOptions& options);

}  // namespace vins::pose_graph
