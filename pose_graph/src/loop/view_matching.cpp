#include "pose_graph/loop/view_matching.h"

#include <algorithm>

#include "vins_core/option_check.h"

namespace vins::pose_graph {
namespace {

/// The descriptors of some features in a row, and which features they are.
struct DescriptorRow {
  std::vector<BriefDescriptor> descriptors;
  std::vector<int> features;

  void clear() {
    descriptors.clear();
    features.clear();
  }
  void add(const ViewFeature& feature, std::size_t index) {
    descriptors.push_back(feature.descriptor);
    features.push_back(static_cast<int>(index));
  }
  NearestDescriptor nearestTo(const BriefDescriptor& descriptor) const {
    return nearestDescriptor(descriptor, descriptors.data(), descriptors.size());
  }
};

/// Takes the features of one node, from `at` on, which moves behind them.
void takeNode(const std::vector<ViewFeature>& features, bool only_points, std::size_t* at,
              DescriptorRow* row) {
  row->clear();
  const std::uint32_t node = features[*at].node;
  for (; *at < features.size() && features[*at].node == node; ++*at) {
    if (!only_points || features[*at].point >= 0) row->add(features[*at], *at);
  }
}

void matchRows(const DescriptorRow& query, const DescriptorRow& old, const MatchOptions& options,
               std::vector<ViewMatch>* matches) {
  for (std::size_t i = 0; i < query.features.size(); ++i) {
    const NearestDescriptor best = old.nearestTo(query.descriptors[i]);
    if (best.distance > options.max_distance ||
        best.distance > options.max_ratio * best.next_distance) {
      continue;
    }
    if (query.nearestTo(old.descriptors[best.index]).index != i) continue;
    matches->push_back({query.features[i], old.features[best.index], best.distance});
  }
}

}  // namespace

void MatchOptions::validate() const {
  requireWithin("view matching", "max_distance", max_distance, {0, kDescriptorBits});
  requireWithin("view matching", "max_ratio", max_ratio, {0.1, 1.0});
}

std::vector<ViewMatch> matchViews(const KeyframeView& query, const KeyframeView& old,
                                  const MatchOptions& options) {
  std::vector<ViewMatch> matches;
  DescriptorRow query_row, old_row;
  std::size_t at_query = 0, at_old = 0;
  while (at_query < query.features.size() && at_old < old.features.size()) {
    const std::uint32_t query_node = query.features[at_query].node;
    const std::uint32_t old_node = old.features[at_old].node;
    if (query_node <= old_node) takeNode(query.features, true, &at_query, &query_row);
    if (old_node <= query_node) takeNode(old.features, false, &at_old, &old_row);
    if (query_node == old_node) matchRows(query_row, old_row, options, &matches);
  }
  return matches;
}

}  // namespace vins::pose_graph
