#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "pose_graph/place/place_database.h"
#include "vins_core/time.h"

namespace vins::pose_graph {

/// What LoopDetector goes by.
struct LoopDetectorOptions {
  int excluded_keyframes = 25;    ///< the last ones before a keyframe are no loop
  double excluded_seconds = 8.0;  ///< nor are those of this time before it [s]
  int query_results = 50;         ///< entries that are looked at
  /// Of the score over that of the keyframe before: T-RO 2012's alpha. Low, because the
  /// verification decides.
  double min_normalized_score = 0.3;
  double min_score = 0.015;      ///< bagScore() below which nothing has been recognised
  int island_gap = 3;            ///< entries of an island are at most so far apart
  int consistent_keyframes = 1;  ///< before this one, that must have led to the same island
  int max_candidates = 3;        ///< handed on

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// A keyframe that may show the same place.
struct LoopCandidate {
  std::int64_t id = 0;            ///< the best entry of its island
  double score = 0.0;             ///< bagScore()
  double normalized_score = 0.0;  ///< over the score of the keyframe before
  double island_score = 0.0;      ///< sum of the island's normalized scores
  int consistent = 0;             ///< keyframes before, in a row, that led to the same island
};

/// Asks a place database, keyframe by keyframe, for places seen before: D. Galvez-Lopez, J. D.
/// Tardos, "Bags of binary words for fast place recognition in image sequences", T-RO 2012,
/// sections IV-A to IV-C. Scores are divided by the one that the keyframe before has, which is
/// about the most to be expected here; neighbouring entries, which show the same place, form
/// islands instead of competing; and neighbouring keyframes must agree.
class LoopDetector {
 public:
  /// Throws InputError for bad options.
  LoopDetector(std::size_t word_count, const LoopDetectorOptions& options);

  /// Candidates for a keyframe, best island first, and adds the keyframe to the entries. Ids must
  /// rise. A stamp before the last one starts a new row of keyframes: nothing is recent then.
  std::vector<LoopCandidate> detect(std::int64_t id, Stamp stamp, const BagOfWords& bag);

  /// Adds an entry without asking: of a map. Throws InputError where the id is there already.
  void add(std::int64_t id, const BagOfWords& bag) { database_.add(id, bag); }

  /// Forgets an entry; false where it is not there.
  bool remove(std::int64_t id) { return database_.remove(id); }

  const PlaceDatabase& database() const { return database_; }

 private:
  struct Recent {
    std::int64_t id;
    Stamp stamp;
  };
  /// Neighbouring entries, by their places in the row of all ids.
  struct Island {
    std::size_t first, last;
    std::int64_t first_id, last_id;
    LoopCandidate best;
  };

  std::int64_t firstExcluded(std::int64_t id, Stamp stamp) const;
  std::vector<Island> islandsOf(const BagOfWords& bag, std::int64_t ids_below) const;
  std::vector<LoopCandidate> choose(std::vector<Island> islands);
  void remember(std::int64_t id, Stamp stamp, const BagOfWords& bag);

  LoopDetectorOptions options_;
  PlaceDatabase database_;
  std::deque<Recent> recent_;
  BagOfWords last_bag_;
  std::vector<Island> last_islands_;  ///< of the keyframe before
};

}  // namespace vins::pose_graph
