#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "pose_graph/loop/level_geometry.h"
#include "pose_graph/loop/pose_refinement.h"
#include "pose_graph/loop/view_matching.h"
#include "pose_graph/place/keyframe_view.h"
#include "vins_core/loop_match.h"

namespace vins::pose_graph {

/// What LoopVerifier asks of a loop. Pixels are those at the image's centre.
struct LoopVerifierOptions {
  MatchOptions matching;
  /// Matches that one pose explains; half as many do where they are more than half of all matches,
  /// and the query has fewer than four times as many points to match.
  int min_inliers = 25;
  /// From an epipolar plane [px]. Wide: roll and pitch are off by some tenths of a degree, of which
  /// each is 0.8 px at 460 px of focal length.
  double epipolar_threshold = 8.0;
  /// From where a pose with the odometry's roll and pitch puts a point [px]: the points' depths add
  /// to the error of the tilt.
  double pose_threshold = 10.0;
  double refined_threshold = 6.0;  ///< the same for the pose of six degrees of freedom [px]
  /// Descriptors are not invariant to rotation, and beyond a third of the field of view little is
  /// seen by both: what agrees then is wrong [deg].
  double max_yaw = 30.0;
  double max_translation = 20.0;  ///< further off nothing in a window looks the same [m]
  /// Between the odometry's gravity and the matches': three sigmas of twice a degree [deg].
  double max_tilt = 4.0;
  int epipolar_samples = 300;  ///< with 60 % of outliers, one in 16 is good
  int pose_samples = 300;      ///< with 60 % of outliers, one in 6 is good
  std::uint64_t seed = 1;      ///< the same views give the same answer, whatever came before

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// Why a loop was accepted or not.
enum class LoopStatus {
  kAccepted,
  kFewMatches,          ///< too few features look alike
  kFewEpipolarInliers,  ///< no motion puts enough of them into epipolar planes
  kFewPoseInliers,      ///< no pose puts enough of the points where they are seen
  kTilted,              ///< the pose contradicts the gravity of the odometry
  kTurnedFar,           ///< a larger yaw than is plausible
  kFarAway,             ///< a larger translation than is plausible
  kAgainstOdometry      ///< the way flown cannot have led there
};

/// "accepted", "few matches", ...
const char* toString(LoopStatus status);

/// What came of comparing two views. Figures of steps that were not reached are zero.
struct LoopVerification {
  LoopStatus status = LoopStatus::kFewMatches;
  std::int64_t query_id = 0;
  std::int64_t old_id = 0;
  std::vector<ViewMatch> matches;       ///< all
  std::vector<std::uint8_t> is_inlier;  ///< 1 or 0 for each match: of the last step reached
  int epipolar_inliers = 0;
  int pose_inliers = 0;
  double yaw = 0.0;       ///< of the query against the old body, about the vertical [rad]
  double distance = 0.0;  ///< between the bodies [m]
  double tilt = 0.0;      ///< between the two gravities [rad]
  Pose T_old_query;       ///< body of the query in the body frame of the old keyframe
  std::vector<MatchedFeature> features;  ///< the inliers of an accepted loop

  bool isAccepted() const { return status == LoopStatus::kAccepted; }

  /// A line for people: status and figures.
  std::string describe() const;
};

/// Decides whether two views show the same place, and where the bodies stood to each other.
///
/// Matches are first judged by bearings alone, then by the query's points in the old view; in both
/// steps by random samples (RANSAC, scored by truncated squares: P. Torr, A. Zisserman, "MLESAC",
/// 2000), with the roll and pitch of the odometry. So three bearings or two points are a sample,
/// which bears many outliers. The pose is then fitted with six degrees of freedom: that its tilt
/// agrees with gravity all the same, nothing has forced. Everything is on unit bearings: cameras of
/// any field of view are served alike.
class LoopVerifier {
 public:
  /// Throws InputError for bad options.
  explicit LoopVerifier(const LoopVerifierOptions& options);

  LoopVerification verify(const KeyframeView& query, const KeyframeView& old) const;

 private:
  struct Problem;

  void judgeByBearings(Problem* problem) const;
  void judgeByPoints(Problem* problem) const;
  bool refine(Problem* problem) const;
  LoopStatus judgePose(Problem* problem) const;
  LoopStatus judge(Problem* problem) const;

  LoopVerifierOptions options_;
};

}  // namespace vins::pose_graph
