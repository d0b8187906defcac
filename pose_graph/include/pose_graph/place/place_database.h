#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "pose_graph/place/vocabulary.h"

namespace vins::pose_graph {

/// A place that looks like the one asked for.
struct PlaceScore {
  std::int64_t id = 0;
  double score = 0.0;  ///< bagScore(), above 0 and up to 1
};

/// Bags of words of places, and for each word the places that have it (an inverted index: J. Sivic,
/// A. Zisserman, "Video Google", ICCV 2003), so that a query looks only at places that share a
/// word with it. Not for use by several threads at once.
class PlaceDatabase {
 public:
  /// For bags of a vocabulary with so many words.
  explicit PlaceDatabase(std::size_t word_count);

  /// Adds a place. Throws InputError where the id is there already, or a word is none.
  void add(std::int64_t id, const BagOfWords& bag);

  /// Forgets a place; false where it is not there.
  bool remove(std::int64_t id);

  bool contains(std::int64_t id) const { return slots_.count(id) != 0; }
  std::size_t size() const { return slots_.size(); }

  /// Bytes that it takes, about.
  std::size_t memory() const;

  /// All ids, rising.
  std::vector<std::int64_t> ids() const;

  /// The places that share words with `bag`, best first, of equally good ones the lowest id; only
  /// those with ids below `ids_below`, and at most `most` of them.
  std::vector<PlaceScore> query(
      const BagOfWords& bag, std::size_t most,
      std::int64_t ids_below = std::numeric_limits<std::int64_t>::max()) const;

 private:
  struct Posting {
    std::uint32_t slot = 0;
    float weight = 0.0F;
  };
  /// Where a place is kept; used again after it was removed.
  struct Slot {
    std::int64_t id = 0;
    std::vector<std::uint32_t> words;
  };

  std::vector<std::vector<Posting>> postings_;  ///< one list for each word
  std::vector<Slot> places_;
  std::vector<std::uint32_t> free_slots_;
  std::map<std::int64_t, std::uint32_t> slots_;  ///< by id
};

}  // namespace vins::pose_graph
