#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pose_graph/graph/keyframe_graph.h"
#include "pose_graph/place/keyframe_view.h"
#include "pose_graph/place/place_model.h"
#include "vins_core/loop_match.h"

namespace vins::pose_graph {

/// A keyframe of a stored map.
struct MapKeyframe {
  KeyframeVertex vertex;               ///< its id is its place in the file, 0, 1, ...
  std::optional<KeyframeView> view;    ///< nodes of features are not stored: they are 0
  std::vector<unsigned char> picture;  ///< a small image as JPEG, for people; may be empty
};

/// What a map file holds. The odometry's edges follow from the keyframes' poses.
struct StoredMap {
  PlaceModelIdentity places;  ///< what it was made with
  std::vector<MapKeyframe> keyframes;
  std::vector<LoopEdge> loops;
};

/// Puts a map into the bytes of a file, keyframe by keyframe.
///
/// The form, all little-endian: "VINSPMAP", uint32 version (1), then sections: a header, one for
/// each keyframe, one for all loops. A section is a uint64 length, so many bytes, and the uint64
/// FNV-1a checksum of all sections' bytes so far, this one's included. So damage is told with its
/// place, and a section that is missing is noticed.
/// - Header: uint64 identity of vocabulary and of pattern, uint32 numbers of keyframes and loops.
/// - Keyframe: int64 stamp; uint32 sequence, 1 or 0 for a view or none, numbers of features and
///   points, bytes of the picture; float64 T_wb, T_mb, view's T_bc (rotation x y z w, position),
///   view's R_wb, pixel angle; per feature uint64[4] descriptor, float32 pixel x y, bearing x y z,
///   int32 point; per point int64 id, float64 position x y z in the body; the picture.
/// - Loop: uint32 query, old, int32 inliers, uint32 0, int64 query stamp, float64 T_old_query,
///   6 x 6 covariance row by row.
/// A keyframe with 600 features of which 120 have points takes 38 kB.
class MapWriter {
 public:
  MapWriter(const PlaceModelIdentity& places, std::size_t keyframes, std::size_t loops);

  /// The next keyframe; its id must be the number of keyframes added before. `view` may be null.
  void addKeyframe(const KeyframeVertex& vertex, const KeyframeView* view,
                   const std::vector<unsigned char>& picture);

  /// All loops, between ids of keyframes that were added; after the keyframes.
  void addLoops(const std::vector<LoopEdge>& loops);

  const std::string& bytes() const { return bytes_; }

  /// Writes the file aside (PATH.part) and renames it; makes its folder where it is missing.
  /// Throws InputError naming what cannot be written; the file that was there is then unharmed.
  void write(const std::string& path) const;

 private:
  void addSection(const std::string& section);

  std::string bytes_;
  std::uint64_t checksum_;
};

/// Reads a map. Memory is given only as far as the file's size bears a count out. Throws
/// InputError naming the file, the byte, and what is wrong there, where it is missing, truncated,
/// damaged, of another kind or of a newer version, or where its content means nothing: stamps of a
/// sequence that do not rise, poses that are none.
StoredMap readMap(const std::string& path);

}  // namespace vins::pose_graph
