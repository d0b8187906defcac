#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pose_graph/pose_graph.h"
#include "revisits.h"
#include "view_fixture.h"

namespace vins::pose_graph::testing {

/// An odometry's world after some drift, seen from the truth.
inline const Pose kDrift(yawRotation(0.03), {0.4, -0.3, 0.2});

/// Pose graphs of a body that comes to the places of Revisits.
class PoseGraphFixture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const BriefPattern pattern = BriefPattern::generate(1, 49);
    places_.vocabulary = std::make_shared<const Vocabulary>(testing::textureVocabulary(pattern));
    places_.pattern = std::make_shared<const BriefPattern>(pattern);
  }
  static void TearDownTestSuite() { places_ = {}; }

  PoseGraphFixture() {
    options_.threaded = false;
    options_.loops.detector.excluded_keyframes = 5;
    options_.loops.detector.excluded_seconds = 2.0;
  }

  std::unique_ptr<PoseGraph> graph() const {
    return std::make_unique<PoseGraph>(options_, revisits_.camera, places_);
  }

  PoseGraphResult visit(PoseGraph* graph, int place, const Pose& T_wm = {},
                        std::uint32_t sequence = 0) {
    return graph->addKeyframe(revisits_.keyframe(next_id_++, place, T_wm, sequence),
                              revisits_.image(place));
  }

  /// Places 0 to 11, then 2, 3, 4 again with an odometry that has drifted; the loops found.
  std::vector<PoseGraphResult> fly(PoseGraph* graph) {
    for (int place = 0; place < 12; ++place) {
      EXPECT_FALSE(visit(graph, place).match) << place;
    }
    std::vector<PoseGraphResult> found;
    for (int place = 2; place < 5; ++place) {
      PoseGraphResult result = visit(graph, place, kDrift);
      if (result.match) found.push_back(std::move(result));
    }
    return found;
  }

  inline static PlaceModel places_;
  const Revisits revisits_;
  PoseGraphOptions options_;
  std::int64_t next_id_ = 0;
};

}  // namespace vins::pose_graph::testing
