#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "pose_graph/loop/loop_detector.h"
#include "pose_graph/loop/loop_verifier.h"
#include "pose_graph/place/keyframe_view.h"
#include "vins_core/keyframe.h"
#include "vins_core/trajectory.h"
#include "vins_pipeline/pipeline.h"

namespace vins::pipeline {

/// A keyframe of a run, its image, and where the body truly stood.
struct StudiedKeyframe {
  Keyframe keyframe;
  cv::Mat image;  ///< CV_8UC1
  Pose T_wb_true;
};

/// A recording's keyframes, by tracker and estimator; those without ground truth are left out.
/// Shows its progress. Throws InputError where there are none.
std::vector<StudiedKeyframe> collectKeyframes(const PipelineOptions& options,
                                              const std::string& recording, double start,
                                              std::optional<double> duration);

/// What place recognition said of one keyframe, and what is true.
struct StudiedQuery {
  std::size_t query = 0;           ///< place in the list of keyframes
  bool can_be_found = false;       ///< an old keyframe that may be asked for overlaps well
  std::optional<std::size_t> old;  ///< the entry with the best score
  double score = 0.0;              ///< bagScore()
  double normalized_score = 0.0;   ///< over that of the keyframe before
  double overlap = 0.0;            ///< with `old`: see overlapOf()
};

/// One verified candidate.
struct StudiedLoop {
  std::size_t query = 0, old = 0;
  double score = 0.0;
  double overlap = 0.0;
  double position_error = 0.0;  ///< of T_old_query [m]
  double rotation_error = 0.0;  ///< of T_old_query [rad]
  pose_graph::LoopVerification verification;
};

/// How the study asks.
struct PlaceStudyOptions {
  pose_graph::ViewOptions view;
  pose_graph::LoopDetectorOptions detector;
  pose_graph::LoopVerifierOptions verifier;
  double found_overlap = 0.3;   ///< from here on an answer is right
  double needed_overlap = 0.5;  ///< from here on a place should have been found
};

/// All answers for one vocabulary, and what they cost.
struct PlaceStudy {
  std::vector<StudiedQuery> queries;
  std::vector<StudiedLoop> loops;
  std::vector<pose_graph::KeyframeView> views;
  double describe_ms = 0.0, detect_ms = 0.0, verify_ms = 0.0;  ///< means
  double verify_worst_ms = 0.0;
  std::size_t largest_view = 0;  ///< [bytes]
};

/// Share of the query's points that the old keyframe has in its image too, by the true poses, and
/// sees from about the same side and distance: 25 degrees and a factor of 1.5. Walls are not known:
/// what they hide is counted, too.
double overlapOf(const StudiedKeyframe& query, const StudiedKeyframe& old,
                 const camera_model::Camera& camera);

/// Asks for each keyframe in turn.
PlaceStudy studyPlaces(const std::vector<StudiedKeyframe>& keyframes,
                       const camera_model::Camera& camera, const pose_graph::Vocabulary& vocabulary,
                       const pose_graph::BriefPattern& pattern, const PlaceStudyOptions& options);

/// A point of the precision-recall curve: answers with at least this normalized score.
struct CurvePoint {
  double threshold = 0.0;
  int answers = 0, right = 0;
  double precision = 1.0, recall = 0.0;
};

/// From the strictest threshold on; a point for each answer.
std::vector<CurvePoint> precisionRecall(const PlaceStudy& study, const PlaceStudyOptions& options);

/// The largest recall of the points without a wrong answer.
double recallWithoutError(const std::vector<CurvePoint>& curve);

}  // namespace vins::pipeline
