#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace vins::simulation {

/// How many tracks a front end had in a span of time, and how long they lived.
struct TrackFigures {
  std::size_t images = 0;
  double tracks = 0.0;    ///< an image, new ones included
  double followed = 0.0;  ///< an image, of them: seen in the image before, too
  double life = 0.0;      ///< images that a track begun in the span was seen in, in the mean
  double age = 0.0;       ///< images that a track of an image had been seen in, in the mean
};

/// Keeps count of the tracks of a recording's images, whatever front end they come from.
class TrackAccount {
 public:
  /// The ids of an image's tracks, `time` after the recording's start [s].
  void add(double time, const std::vector<std::int64_t>& ids);

  /// Of the images from `begin` on and before `end` [s].
  TrackFigures figures(double begin, double end) const;

 private:
  struct Image {
    double time = 0.0;
    double tracks = 0.0, followed = 0.0, ages = 0.0;
  };
  struct Track {
    double begin = 0.0;
    int images = 0;
  };

  std::vector<Image> images_;
  std::map<std::int64_t, Track> tracks_;
};

}  // namespace vins::simulation
