#include "keyframe_numbering.h"

#include <gtest/gtest.h>

namespace vins::pose_graph {
namespace {

Keyframe keyframeOf(std::int64_t id, std::uint32_t sequence) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.sequence = sequence;
  return keyframe;
}

TEST(KeyframeNumbering, LeavesOneRunAsItIs) {
  KeyframeNumbering numbering;
  for (const std::int64_t id : {0, 1, 5}) {
    Keyframe keyframe = keyframeOf(id, id > 1 ? 1 : 0);
    EXPECT_FALSE(numbering.take(&keyframe));
    EXPECT_EQ(keyframe.id, id);
    EXPECT_EQ(keyframe.sequence, id > 1 ? 1u : 0u);
  }
}

TEST(KeyframeNumbering, ANewRunHasIdsAndSequencesOfItsOwn) {
  KeyframeNumbering numbering;
  Keyframe old = keyframeOf(9, 2);
  old.world = 1;
  numbering.take(&old);
  Keyframe keyframe = keyframeOf(0, 0);
  EXPECT_TRUE(numbering.take(&keyframe));
  EXPECT_EQ(keyframe.id, 10);
  EXPECT_EQ(keyframe.sequence, 3u);
  EXPECT_EQ(keyframe.world, 2u) << "of its own";
  Keyframe next = keyframeOf(1, 0);
  EXPECT_FALSE(numbering.take(&next));
  EXPECT_EQ(next.id, 11);
}

TEST(KeyframeNumbering, WhatGoesToAndFroIsNumberedAlike) {
  KeyframeNumbering numbering;
  Keyframe old = keyframeOf(9, 0);
  Keyframe keyframe = keyframeOf(4, 0);
  numbering.take(&old);
  numbering.take(&keyframe);
  LoopMatch match;
  match.query_id = keyframe.id;
  match.old_id = old.id;
  numbering.giveBack(&match);
  EXPECT_EQ(match.query_id, 4) << "the estimator's";
  EXPECT_EQ(match.old_id, 9) << "the graph's: to the estimator it is only a name";
  LoopEdge edge;
  edge.query_id = match.query_id;
  edge.old_id = match.old_id;
  numbering.take(&edge);
  EXPECT_EQ(edge.query_id, keyframe.id);
  EXPECT_EQ(edge.old_id, old.id);
  KeyframePoseUpdate update;
  update.keyframe_id = 4;
  numbering.take(&update);
  EXPECT_EQ(update.keyframe_id, keyframe.id);
  EXPECT_EQ(update.sequence, keyframe.sequence);
}

}  // namespace
}  // namespace vins::pose_graph
