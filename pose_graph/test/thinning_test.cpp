#include "pose_graph/graph/thinning.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "pose_graph/graph/heading.h"
#include "synthetic_keyframes.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

ThinningOptions keepAtMost(int count, int newest = 0) {
  ThinningOptions options;
  options.max_keyframes = count;
  options.newest = newest;
  options.thin_to = 1.0;
  return options;
}

/// Keyframes 0, 1, ... at these places, looking in these directions.
KeyframeGraph graphAt(const std::vector<std::pair<Eigen::Vector3d, double>>& places) {
  KeyframeGraph graph;
  std::int64_t id = 0;
  for (const auto& [position, yaw] : places) {
    graph.addKeyframe(id, 0, id + 1, Pose(yawRotation(yaw), position));
    ++id;
  }
  return graph;
}

TEST(Thinning, LeavesAMapThatIsNotFullAlone) {
  KeyframeGraph graph;
  testing::SyntheticKeyframes(50, 20, 0.0, 1).addTo(&graph);
  EXPECT_TRUE(redundantKeyframes(graph, keepAtMost(50)).empty());
  EXPECT_EQ(redundantKeyframes(graph, keepAtMost(49)).size(), 1u);
}

TEST(Thinning, TakesTheDensestPlacesFirst) {
  // Ten places a metre apart; at 4 and 7 there is a second keyframe close by.
  std::vector<std::pair<Eigen::Vector3d, double>> places;
  for (int i = 0; i < 10; ++i) places.push_back({{1.0 * i, 0.0, 0.0}, 0.0});
  places.push_back({{4.0, 0.02, 0.0}, 0.0});
  places.push_back({{7.0, 0.01, 0.0}, 0.0});
  // Of each pair the older goes, the closest pair first.
  EXPECT_EQ(redundantKeyframes(graphAt(places), keepAtMost(10)), (std::vector<std::int64_t>{7, 4}));
}

TEST(Thinning, ATurnSetsKeyframesApart) {
  std::vector<std::pair<Eigen::Vector3d, double>> places;
  for (int i = 0; i < 9; ++i) places.push_back({{1.0 * i, 0.0, 0.0}, 0.0});
  places.push_back({{2.0, 0.0, 0.0}, 2.0});  // the same place, another view
  places.push_back({{6.0, 0.3, 0.0}, 0.0});
  EXPECT_EQ(redundantKeyframes(graphAt(places), keepAtMost(10)), (std::vector<std::int64_t>{6}));
  ThinningOptions blind = keepAtMost(10);
  blind.metres_per_radian = 0.0;
  EXPECT_EQ(redundantKeyframes(graphAt(places), blind), (std::vector<std::int64_t>{2}));
}

TEST(Thinning, LoopEndsAndTheNewestStay) {
  const testing::SyntheticKeyframes run(100, 20, 0.0, 2);
  KeyframeGraph graph;
  run.addTo(&graph);
  std::set<std::int64_t> staying;
  for (std::size_t i = 20; i < 80; i += 3) {
    graph.addLoopEdge(run.loop(i - 20, i));
    staying.insert({std::int64_t(i) - 20, std::int64_t(i)});
  }
  for (int i = 90; i < 100; ++i) staying.insert(i);
  const int others = 100 - static_cast<int>(staying.size());
  const auto removed = redundantKeyframes(graph, keepAtMost(100 - others, 10));
  EXPECT_EQ(removed.size(), static_cast<std::size_t>(others));
  EXPECT_EQ(std::set<std::int64_t>(removed.begin(), removed.end()).size(), removed.size());
  for (const std::int64_t id : removed) EXPECT_EQ(staying.count(id), 0u) << id;
}

TEST(Thinning, LoopEndsLeaveWhenNoOthersAreLeft) {
  // Round after round at the same places: each keyframe from the second round on closes a loop.
  const testing::SyntheticKeyframes run(200, 20, 0.001, 2);
  KeyframeGraph graph;
  run.addTo(&graph);
  for (std::size_t i = 20; i < 200; ++i) graph.addLoopEdge(run.loop(i - 20, i));
  const auto removed = redundantKeyframes(graph, keepAtMost(50, 10));
  EXPECT_EQ(removed.size(), 150u) << "the map is bounded all the same";
  for (const std::int64_t id : removed) {
    EXPECT_LT(id, 190) << "the newest stay";
    EXPECT_TRUE(graph.removeKeyframe(id));
  }
  EXPECT_LE(graph.loops().size(), 50u) << "loops do not pile up";
  EXPECT_GE(graph.loops().size(), 10u) << "nor are they lost";
}

TEST(Thinning, KeyframesWithoutACommonFrameAreNotCompared) {
  KeyframeGraph graph;
  for (int i = 0; i < 10; ++i) graph.addKeyframe(i, 0, i + 1, Pose({1, 0, 0, 0}, {1.0 * i, 0, 0}));
  // As if it stood on keyframe 3, in an odometry's world that no loop has tied to the map.
  graph.addKeyframe(10, 1, 1, Pose({1, 0, 0, 0}, {3.0, 0, 0}));
  graph.addKeyframe(11, 1, 2, Pose({1, 0, 0, 0}, {5.1, 0.1, 0}));
  const auto removed = redundantKeyframes(graph, keepAtMost(11));
  ASSERT_EQ(removed.size(), 1u);
  EXPECT_EQ(removed[0], 0) << "all neighbours are a metre away: the oldest goes";
}

TEST(Thinning, IsAsGoodAsComparingAllWithAll) {
  const testing::SyntheticKeyframes run(150, 37, 0.05, 3);
  KeyframeGraph graph;
  run.addTo(&graph);
  const auto removed = redundantKeyframes(graph, keepAtMost(60));
  // The definition, without any search structure.
  std::vector<KeyframeVertex> left;
  for (const auto& item : graph.vertices()) left.push_back(item.second);
  const double metres_per_radian = ThinningOptions().metres_per_radian;
  for (const std::int64_t id : removed) {
    double closest = 1e9;
    std::int64_t expected = -1;
    for (const KeyframeVertex& a : left) {
      for (const KeyframeVertex& b : left) {
        if (a.id == b.id) continue;
        const double turn = a.T_mb.rotation.angularDistance(b.T_mb.rotation);
        const double d =
            std::hypot((a.T_mb.position - b.T_mb.position).norm(), metres_per_radian * turn);
        // Seen from either side the distance differs by rounding.
        if (d < closest - 1e-12) {
          closest = d;
          expected = a.id;
        }
      }
    }
    EXPECT_EQ(id, expected);
    left.erase(std::find_if(left.begin(), left.end(), [id](const auto& v) { return v.id == id; }));
  }
  EXPECT_EQ(left.size(), 60u);
}

TEST(Thinning, RefusesOptionsOutOfRange) {
  ThinningOptions options;
  options.thin_to = 1.5;
  EXPECT_THROW(redundantKeyframes(KeyframeGraph(), options), InputError);
}

}  // namespace
}  // namespace vins::pose_graph
