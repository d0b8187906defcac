#pragma once

#include <cstddef>
#include <vector>

#include "vins_core/time.h"

namespace vins::pipeline {

/// Orders a recording's messages by the stamps of their headers. The order of arrival stays where
/// header stamps cannot order: where the clocks of camera and IMU are apart (no overlap), or where
/// a stream's stamps fall by more than a second (a recording of several runs). Messages of equal
/// stamps keep the order of arrival.
class StampOrder {
 public:
  enum class Stream { kImu, kImage, kTruth };

  /// Adds a message in the order of arrival. `stamp`: of its header [ns].
  void add(Stream stream, Stamp stamp);

  /// Call once, after the last message.
  void sort();

  /// Indices of messages, in the order in which they are to be used.
  const std::vector<std::size_t>& place() const { return place_; }

 private:
  /// The time that the stamps of a stream span, and their largest fall.
  struct Span {
    bool is_empty = true;
    Stamp first = 0, last = 0;
    bool falls = false;
    void add(Stamp stamp);
  };

  bool areComparable() const;

  std::vector<Stamp> stamps_;
  std::vector<std::size_t> place_;
  Span imu_, images_;
};

}  // namespace vins::pipeline
