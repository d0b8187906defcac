#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "vins_core/event.h"
#include "vins_core/time.h"
#include "vins_estimator/health/rig_error.h"

namespace vins::estimator {

/// A range of sizes, in RigErrorVector's units.
struct RigErrorSizes {
  double least = 0.0;
  double most = 0.0;
};

/// Options of RigCheck.
struct RigCheckOptions {
  std::vector<RigPart> suspects;   ///< parts that may be found wrong
  std::vector<RigPart> estimated;  ///< parts that the window refines: no suspects
  double settling = 3.0;           ///< after a start that is not judged [s]
  std::size_t min_windows = 4;     ///< before anything is said
  std::size_t max_windows = 60;    ///< kept: some minutes
  /// Errors that are reported. Smaller ones do little harm; larger ones are no small errors about
  /// the present rig any more, and are feigned by windows in which little shows them.
  RigErrorSizes translation{0.03, 0.5};    ///< [m]
  RigErrorSizes rotation{0.0087, 0.26};    ///< half a degree to 15 degrees [rad]
  RigErrorSizes time_offset{0.005, 0.1};   ///< [s]
  RigErrorSizes readout{0.003, 0.1};       ///< [s]
  RigErrorSizes focal_length{0.01, 0.15};  ///< as a share of it
  double min_share = 0.02;                 ///< of the sum of squares that the error must explain
  double min_deviations = 5.0;  ///< of the error from zero, the windows' scatter included
  double min_lead = 1.3;        ///< of its gain over that of any other part's error
};

/// Tells when one part of the rig - the camera's rotation or place in the body, its time offset,
/// read-out or focal length - is wrong, by the scores of windows that do not overlap in time.
/// Events: `rig_rotation`, `rig_translation`, `rig_time_offset`, `rig_readout`, `rig_focal_length`,
/// once each time that the verdict changes, and `rig_agrees` when a verdict no longer holds. Sizes
/// are lower bounds: robust weights and the outlier gate take the part of large errors away that
/// shows them best. (Limits were measured: right rigs on simulated and recorded flights stay below
/// 1.8 % of the sum of squares.)
class RigCheck {
 public:
  explicit RigCheck(const RigCheckOptions& options) : options_(options) {}

  /// The estimator has started, or started anew: what it sees from some seconds after `stamp` on
  /// counts. Earlier scores are kept, for the rig is the same.
  void begin(Stamp stamp);

  /// Whether a window whose oldest frame has this stamp is to be scored: none of its frames has
  /// been in a scored window before.
  bool isDue(Stamp oldest) const { return not_before_ && oldest >= *not_before_; }

  /// Takes the score of a window whose newest frame has this stamp; an event where it changes the
  /// verdict.
  std::optional<Event> addScore(Stamp newest, const RigScore& score);

  /// The part that is found wrong.
  std::optional<RigPart> verdict() const { return verdict_; }

  /// Forgets scores and verdict, until begin().
  void clear();

 private:
  const RigErrorSizes& sizesOf(RigPart part) const;
  bool isConvincing(const RigExplanation& explanation) const;
  bool stillHolds(const RigExplanation& explanation) const;
  std::vector<RigExplanation> explainAll() const;
  std::optional<RigExplanation> judge() const;

  RigCheckOptions options_;
  std::deque<RigScore> scores_;
  std::optional<Stamp> not_before_;
  std::optional<RigPart> verdict_;
};

}  // namespace vins::estimator
