#pragma once

#include <algorithm>
#include <cstdint>

namespace vins {

/// Ids given by a program that may die and be started again: it then counts from 0 anew, while who
/// hears it still remembers the old ones. Here they go on above all that have been.
class ContinuedIds {
 public:
  /// The id, 0 or more, as it is known here.
  std::int64_t continued(std::int64_t id) {
    next_ = std::max(next_, id + offset_ + 1);
    return id + offset_;
  }

  /// The same, of an id of which nothing new is learnt: it does not count as having been.
  std::int64_t lookUp(std::int64_t id) const { return id + offset_; }

  /// The id as the running program knows it; negative where it is a former one's.
  std::int64_t original(std::int64_t continued) const { return continued - offset_; }

  /// The program has been started again.
  void startAgain() { offset_ = next_; }

 private:
  std::int64_t offset_ = 0;
  std::int64_t next_ = 0;
};

}  // namespace vins
