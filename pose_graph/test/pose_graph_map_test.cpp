// Maps that are saved, loaded, relocalised in and joined.

#include <algorithm>

#include "pose_graph/pose_graph.h"
#include "pose_graph_fixture.h"
#include "synthetic_keyframes.h"
#include "temp_folder.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using testing::difference;
using testing::kDrift;
using testing::Revisits;

// Matches of identical images are exact but for the bearings' single precision: some 1e-4 where a
// loop is measured, and ten times as much ten metres away.
constexpr double kMeasured = 1e-3;

class PoseGraphMap : public testing::PoseGraphFixture {
 protected:
  PoseGraphMap() {
    // Without drift the second visit stands where the first one stood: it is kept all the same.
    options_.skip_distance = 0.0;
  }

  /// A run through places 0 to 11 and again 2 to 4, with an odometry that is exact: saved.
  std::string flyAndSave(const std::string& name) {
    const auto graph = this->graph();
    for (int visits = 0; visits < 15; ++visits)
      visit(graph.get(), visits < 12 ? visits : visits - 10);
    EXPECT_GE(graph->statistics().loops, 1u);
    graph->finish();
    const std::string path = folder_.file(name);
    EXPECT_EQ(graph->save(path), 15u);
    return path;
  }

  /// A new process: ids start again.
  std::unique_ptr<PoseGraph> graphWith(const std::string& path) {
    auto graph = this->graph();
    graph->load(path);
    next_id_ = 0;
    return graph;
  }

  static std::vector<KeyframeVertex> keyframesOf(PoseGraph* graph) {
    std::vector<KeyframeVertex> all;
    for (const SequencePath& path : graph->paths()) {
      all.insert(all.end(), path.keyframes.begin(), path.keyframes.end());
    }
    return all;
  }

  const testing::TempFolder folder_{"pose_graph_map_test"};
};

TEST_F(PoseGraphMap, ComesBackAsItWas) {
  const auto before = graph();
  fly(before.get());
  before->finish();
  before->save(folder_.file("a.map"));
  const auto after = graph();
  const LoadedMap loaded = after->load(folder_.file("a.map"));
  EXPECT_EQ(loaded.keyframes, 15u);
  EXPECT_EQ(loaded.sequences, 1u);
  EXPECT_EQ(loaded.loops, before->loops().size());
  EXPECT_EQ(loaded.without_view, 0u);
  EXPECT_TRUE(loaded.same_vocabulary);
  const auto expected = keyframesOf(before.get()), found = keyframesOf(after.get());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].id, expected[i].id - 15) << "below all that will come";
    EXPECT_EQ(found[i].sequence, -1);
    EXPECT_EQ(found[i].stamp, expected[i].stamp);
    EXPECT_EQ(found[i].T_mb.matrix(), expected[i].T_mb.matrix());
    EXPECT_EQ(found[i].T_wb.matrix(), expected[i].T_wb.matrix());
  }
  EXPECT_TRUE(after->paths()[0].in_map);
  EXPECT_LT(difference(after->drift(-1).value(), before->drift(0).value()), 1e-12) << "rounding";
  // The same bytes again: nothing is lost on the way.
  after->save(folder_.file("b.map"));
  EXPECT_EQ(testing::bytesOf(folder_.file("a.map")), testing::bytesOf(folder_.file("b.map")));
}

TEST_F(PoseGraphMap, ANewRunStandsAloneUntilALoopJoinsIt) {
  const auto graph = graphWith(flyAndSave("a.map"));
  const Pose first_before = keyframesOf(graph.get()).front().T_mb;
  const Pose elsewhere(yawRotation(2.0), {30.0, 10.0, -3.0});
  for (int place = 40; place < 44; ++place) {
    EXPECT_FALSE(visit(graph.get(), place, elsewhere).match) << "not on the map";
  }
  ASSERT_EQ(graph->paths().size(), 2u);
  EXPECT_FALSE(graph->paths()[1].in_map);
  EXPECT_LT(difference(graph->drift(0).value(), Pose()), 1e-12) << "in its own frame";

  // Two keyframes at known places must agree: with the second the run is in the map at the latest.
  int place = 6;
  PoseGraphResult result = visit(graph.get(), place, elsewhere);
  if (!result.match) result = visit(graph.get(), ++place, elsewhere);
  ASSERT_TRUE(result.match);
  EXPECT_EQ(result.match->old_id, place - 15) << "the same place, in the loaded map";
  EXPECT_TRUE(graph->paths()[1].in_map);
  EXPECT_LT(difference(graph->drift(0).value() * elsewhere, Pose()), kMeasured);
  const auto joined = std::find_if(result.events.begin(), result.events.end(),
                                   [](const Event& e) { return e.code == "sequence_joined"; });
  EXPECT_NE(joined, result.events.end());
  graph->finish();
  EXPECT_EQ(difference(keyframesOf(graph.get()).front().T_mb, first_before), 0.0)
      << "the first vertex is fixed";
}

TEST_F(PoseGraphMap, IsRelocalisedInByTheFirstKeyframesOfARun) {
  const auto graph = graphWith(flyAndSave("a.map"));
  // Stamps and ids begin as those of the map did: neither may count as recent. The first keyframe
  // has none before it that could agree.
  EXPECT_FALSE(visit(graph.get(), 5).match);
  EXPECT_TRUE(visit(graph.get(), 6).match);
}

TEST_F(PoseGraphMap, GrowsFromRunToRun) {
  std::string path = flyAndSave("0.map");
  // Each run begins in a frame of its own, at a place the last one had added.
  for (int run = 1; run <= 3; ++run) {
    const auto graph = graphWith(path);
    const Pose frame(yawRotation(run), {5.0 * run, -3.0, 1.0});
    const int first = 4 + 6 * run;
    for (int place = first; place < first + 8; ++place) visit(graph.get(), place, frame);
    graph->finish();
    for (const SequencePath& sequence : graph->paths()) EXPECT_TRUE(sequence.in_map);
    path = folder_.file(std::to_string(run) + ".map");
    graph->save(path);
  }
  const auto graph = graphWith(path);
  EXPECT_EQ(graph->paths().size(), 4u);
  EXPECT_EQ(graph->statistics().keyframes, 15u + 3 * 8u);
  const KeyframeVertex last = keyframesOf(graph.get()).back();
  EXPECT_EQ(last.sequence, -1);
  // Three joins, each of them as exact as a loop.
  EXPECT_LT(difference(last.T_mb, Revisits::truth(29)), 3.0 * kMeasured);
}

TEST_F(PoseGraphMap, SequencesThatAreNotJoinedStayApart) {
  const auto first = graphWith(flyAndSave("a.map"));
  const Pose elsewhere(yawRotation(2.0), {30.0, 10.0, -3.0});
  for (int place = 40; place < 45; ++place) visit(first.get(), place, elsewhere);
  first->finish();
  first->save(folder_.file("b.map"));

  const auto second = graphWith(folder_.file("b.map"));
  ASSERT_EQ(second->paths().size(), 2u);
  EXPECT_TRUE(second->paths()[0].in_map);
  EXPECT_FALSE(second->paths()[1].in_map);
  EXPECT_LT(difference(second->paths()[1].keyframes[0].T_mb, elsewhere * Revisits::truth(40)),
            1e-12)
      << "in its own frame still";
  // A run that sees both joins them.
  for (const int place : {41, 42, 43, 44, 5, 6, 7}) visit(second.get(), place, kDrift);
  for (const SequencePath& path : second->paths()) EXPECT_TRUE(path.in_map) << path.sequence;
}

TEST_F(PoseGraphMap, CanBeLoadedInTheMiddleOfARun) {
  const std::string path = flyAndSave("a.map");
  next_id_ = 0;
  const auto graph = this->graph();
  for (int place = 40; place < 43; ++place) visit(graph.get(), place, kDrift);
  graph->load(path);
  EXPECT_FALSE(graph->paths().back().in_map) << "the loaded map is the map now";
  visit(graph.get(), 5, kDrift);
  EXPECT_TRUE(visit(graph.get(), 6, kDrift).match);
  EXPECT_TRUE(graph->paths().back().in_map);
  EXPECT_LT(difference(graph->drift(0).value() * kDrift, Pose()), kMeasured);
  // And a second one below the first.
  graph->load(path);
  EXPECT_EQ(graph->paths().front().keyframes.front().id, -30);
  EXPECT_EQ(graph->paths().front().sequence, -2);
}

TEST_F(PoseGraphMap, AnotherVocabularyFindsTheWordsAnew) {
  const std::string path = flyAndSave("a.map");
  std::vector<std::vector<BriefDescriptor>> images;
  const BriefExtractor brief(*places_.pattern);
  for (int seed = 200; seed < 206; ++seed) {
    const cv::Mat1b image = testing::texturedImage(752, 480, seed);
    images.push_back(brief.describe(image, findSpreadCorners(image, {}, {})).descriptors);
  }
  VocabularyTrainingOptions training;
  training.levels = 4;
  training.fewest_to_split = 2;
  const PlaceModel other{std::make_shared<const Vocabulary>(trainVocabulary(images, training)),
                         places_.pattern};
  PoseGraph graph(options_, revisits_.camera, other);
  EXPECT_FALSE(graph.load(path).same_vocabulary);
  next_id_ = 0;
  visit(&graph, 5);
  EXPECT_TRUE(visit(&graph, 6).match);
}

TEST_F(PoseGraphMap, AnotherPatternIsRefused) {
  const std::string path = flyAndSave("a.map");
  const PlaceModel other{places_.vocabulary,
                         std::make_shared<const BriefPattern>(BriefPattern::generate(2, 49))};
  PoseGraph graph(options_, revisits_.camera, other);
  EXPECT_THROW(graph.load(path), InputError);
  EXPECT_EQ(graph.statistics().keyframes, 0u);
}

TEST_F(PoseGraphMap, WhatCannotBeReadChangesNothing) {
  const std::string path = flyAndSave("a.map");
  std::string bytes = testing::bytesOf(path);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] + 1);
  testing::writeBytes(folder_.file("broken.map"), bytes);
  const auto graph = graphWith(path);
  EXPECT_THROW(graph->load(folder_.file("broken.map")), InputError);
  EXPECT_EQ(graph->statistics().keyframes, 15u);
  visit(graph.get(), 5);
  EXPECT_TRUE(visit(graph.get(), 6).match) << "works on";
  EXPECT_THROW(this->graph()->save(path), InputError) << "an empty map replaces none";
  EXPECT_NE(testing::bytesOf(path), "");
}

TEST_F(PoseGraphMap, PicturesTravelAlong) {
  const auto before = graph();
  fly(before.get());
  PictureStore pictures(100), found(100);
  pictures.add(3, revisits_.image(3));
  before->save(folder_.file("a.map"), &pictures);
  graph()->load(folder_.file("a.map"), &found);
  EXPECT_EQ(found.size(), 1u);
  EXPECT_EQ(found.encoded(3 - 15), pictures.encoded(3));
}

TEST_F(PoseGraphMap, AMapLargerThanTheLimitIsThinned) {
  const std::string path = flyAndSave("a.map");
  options_.thinning.max_keyframes = 12;
  options_.thinning.newest = 2;
  const auto graph = this->graph();
  graph->load(path);
  EXPECT_LE(graph->statistics().keyframes, 12u);
  EXPECT_GE(graph->statistics().loops, 1u) << "loops stay";
}

}  // namespace
}  // namespace vins::pose_graph
