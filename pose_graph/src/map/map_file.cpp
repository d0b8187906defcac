#include "pose_graph/map/map_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "place/binary_file.h"
#include "place/byte_reader.h"
#include "vins_core/input_error.h"
#include "vins_core/text_file.h"

namespace vins::pose_graph {
namespace {

/// Records as they lie in the file.
namespace map_record {

struct Header {
  std::uint64_t vocabulary, pattern;
  std::uint32_t keyframes, loops;
};

struct RigidTransform {
  std::array<double, 4> rotation;  ///< x y z w
  std::array<double, 3> position;
};

struct Keyframe {
  std::int64_t stamp;
  std::uint32_t sequence, has_view, features, points, picture, zero;
  RigidTransform T_wb, T_mb, T_bc;
  std::array<double, 4> R_wb;  ///< x y z w
  double pixel_angle;
};

struct Feature {
  BriefDescriptor descriptor;
  std::array<float, 2> pixel;
  std::array<float, 3> bearing;
  std::int32_t point;
};

struct Point {
  std::int64_t id;
  std::array<double, 3> position_b;
};

struct Loop {
  std::uint32_t query, old;
  std::int32_t inliers;
  std::uint32_t zero;
  std::int64_t query_stamp;
  RigidTransform T_old_query;
  std::array<double, 36> covariance;  ///< row by row
};

static_assert(sizeof(Header) == 24 && sizeof(Keyframe) == 240 && sizeof(Feature) == 56 &&
                  sizeof(Point) == 32 && sizeof(Loop) == 368,
              "without gaps, as in the file");

constexpr char kMagic[] = "VINSPMAP";
constexpr std::size_t kMagicLength = 8;
constexpr std::uint32_t kVersion = 1;

}  // namespace map_record

std::array<double, 4> toRecord(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

std::array<double, 3> toRecord(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

map_record::RigidTransform toRecord(const Pose& pose) {
  return {toRecord(pose.rotation), toRecord(pose.position)};
}

map_record::Feature toRecord(const ViewFeature& feature) {
  return {feature.descriptor,
          {feature.pixel.x(), feature.pixel.y()},
          {feature.bearing.x(), feature.bearing.y(), feature.bearing.z()},
          feature.point};
}

map_record::Loop toRecord(const LoopEdge& loop) {
  map_record::Loop record{};
  record.query = static_cast<std::uint32_t>(loop.query_id);
  record.old = static_cast<std::uint32_t>(loop.old_id);
  record.inliers = loop.inliers;
  record.query_stamp = loop.query_stamp;
  record.T_old_query = toRecord(loop.T_old_query);
  for (int i = 0; i < 36; ++i) {
    record.covariance[static_cast<std::size_t>(i)] = loop.covariance(i / 6, i % 6);
  }
  return record;
}

constexpr double kUnitTolerance = 1e-3;  // single precision, with much room

Eigen::Vector3d toVector(const std::array<double, 3>& v, const char* name,
                         const ByteReader& reader) {
  const Eigen::Vector3d vector(v[0], v[1], v[2]);
  if (!vector.allFinite()) reader.fail(std::string(name) + " is not finite");
  return vector;
}

Eigen::Quaterniond toRotation(const std::array<double, 4>& q, const char* name,
                              const ByteReader& reader) {
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  if (!(std::abs(rotation.norm() - 1.0) < kUnitTolerance)) {
    reader.fail(std::string(name) + " has a quaternion of length " +
                std::to_string(rotation.norm()) + "; allowed: 1");
  }
  return rotation;
}

Pose toPose(const map_record::RigidTransform& pose, const char* name, const ByteReader& reader) {
  return {toRotation(pose.rotation, name, reader), toVector(pose.position, name, reader)};
}

ViewFeature toFeature(const map_record::Feature& record, std::size_t points,
                      const ByteReader& reader) {
  ViewFeature feature;
  feature.descriptor = record.descriptor;
  feature.pixel = {record.pixel[0], record.pixel[1]};
  feature.bearing = {record.bearing[0], record.bearing[1], record.bearing[2]};
  feature.point = record.point;
  const bool is_unit = std::abs(feature.bearing.norm() - 1.0F) < kUnitTolerance;
  if (!is_unit || !feature.pixel.allFinite()) reader.fail("a feature's place means nothing");
  if (record.point < -1 || record.point >= static_cast<std::int64_t>(points)) {
    reader.fail("a feature has point " + std::to_string(record.point) + " of " +
                std::to_string(points));
  }
  return feature;
}

/// Takes a map file apart, section by section.
class MapReader {
 public:
  MapReader(const std::string& bytes, const std::string& path)
      : path_(path), reader_(bytes, path) {}

  StoredMap read() {
    checkKind();
    const map_record::Header header = readHeader();
    StoredMap map;
    map.places = {header.vocabulary, header.pattern};
    map.keyframes.reserve(header.keyframes);
    for (std::uint32_t i = 0; i < header.keyframes; ++i) map.keyframes.push_back(readKeyframe(i));
    readLoops(header, &map.loops);
    if (reader_.left() > 0) reader_.fail(std::to_string(reader_.left()) + " bytes too many");
    return map;
  }

 private:
  void checkKind() {
    const std::size_t length = std::min(map_record::kMagicLength, reader_.left());
    const std::vector<char> magic = reader_.takeMany<char>(length);
    if (std::string(magic.begin(), magic.end()) != map_record::kMagic) {
      reader_.fail("is no map of this program, which begins with \"VINSPMAP\"");
    }
    const auto version = reader_.take<std::uint32_t>();
    if (version != map_record::kVersion) {
      reader_.fail("version is " + std::to_string(version) +
                   (version > map_record::kVersion ? ", of a newer program" : "") +
                   "; readable: " + std::to_string(map_record::kVersion));
    }
  }

  /// The next section, whole by its checksum.
  ByteReader takeSection(const std::string& name) {
    const auto length = reader_.take<std::uint64_t>();
    if (length > reader_.left()) {
      reader_.fail(name + ": the file ends early, or is damaged: " + std::to_string(length) +
                   " bytes were to come, " + std::to_string(reader_.left()) + " are there");
    }
    ByteReader section = reader_.takePart(length, path_ + ": " + name);
    checksum_ = checksum(section.data(), section.size(), checksum_);
    if (reader_.take<std::uint64_t>() != checksum_) {
      section.fail("the checksum does not fit: the file is damaged");
    }
    return section;
  }

  map_record::Header readHeader() {
    ByteReader section = takeSection("header");
    const auto header = section.take<map_record::Header>();
    // Each keyframe takes more than its record, which bounds the memory that a count can ask for.
    if (header.keyframes > reader_.left() / sizeof(map_record::Keyframe)) {
      section.fail("the file is too short for " + std::to_string(header.keyframes) + " keyframes");
    }
    if (header.keyframes == 0) section.fail("the map has no keyframe");
    return header;
  }

  MapKeyframe readKeyframe(std::uint32_t index) {
    ByteReader section = takeSection("keyframe " + std::to_string(index));
    const auto record = section.take<map_record::Keyframe>();
    MapKeyframe keyframe;
    keyframe.vertex = {index, record.sequence, record.stamp, toPose(record.T_wb, "T_wb", section),
                       toPose(record.T_mb, "T_mb", section)};
    const auto last = last_stamps_.find(record.sequence);
    if (last != last_stamps_.end() && last->second >= record.stamp) {
      section.fail("the stamp " + std::to_string(record.stamp) +
                   " is not later than the one before");
    }
    last_stamps_[record.sequence] = record.stamp;
    if (record.has_view == 1) keyframe.view = readView(index, record, &section);
    keyframe.picture = section.takeMany<unsigned char>(record.picture);
    if (record.has_view > 1 || section.left() > 0) section.fail("holds more than it tells of");
    return keyframe;
  }

  static KeyframeView readView(std::uint32_t index, const map_record::Keyframe& record,
                               ByteReader* section) {
    KeyframeView view;
    view.id = index;
    view.R_wb = toRotation(record.R_wb, "R_wb", *section);
    view.T_bc = toPose(record.T_bc, "T_bc", *section);
    view.pixel_angle = record.pixel_angle;
    if (!(view.pixel_angle > 0.0 && view.pixel_angle < 1.0)) section->fail("a pixel has no angle");
    const auto features = section->takeMany<map_record::Feature>(record.features);
    const auto points = section->takeMany<map_record::Point>(record.points);
    view.features.reserve(features.size());
    for (const map_record::Feature& feature : features) {
      view.features.push_back(toFeature(feature, points.size(), *section));
    }
    view.points.reserve(points.size());
    for (const map_record::Point& point : points) {
      view.points.push_back({point.id, toVector(point.position_b, "a point", *section)});
    }
    return view;
  }

  void readLoops(const map_record::Header& header, std::vector<LoopEdge>* loops) {
    ByteReader section = takeSection("loops");
    for (const auto& record : section.takeMany<map_record::Loop>(header.loops)) {
      LoopEdge loop;
      loop.query_id = record.query;
      loop.old_id = record.old;
      loop.inliers = record.inliers;
      loop.query_stamp = record.query_stamp;
      loop.T_old_query = toPose(record.T_old_query, "T_old_query", section);
      for (int i = 0; i < 36; ++i) {
        loop.covariance(i / 6, i % 6) = record.covariance[static_cast<std::size_t>(i)];
      }
      const bool has_ends = record.query < header.keyframes && record.old < header.keyframes &&
                            record.query != record.old;
      if (!has_ends) section.fail("a loop's end is no keyframe");
      if (!loop.covariance.allFinite()) section.fail("a loop's covariance is not finite");
      loops->push_back(loop);
    }
    if (section.left() > 0) section.fail("holds more than it tells of");
  }

  std::string path_;
  ByteReader reader_;
  std::uint64_t checksum_ = kChecksumStart;
  std::map<std::uint32_t, Stamp> last_stamps_;  ///< by sequence
};

}  // namespace

MapWriter::MapWriter(const PlaceModelIdentity& places, std::size_t keyframes, std::size_t loops)
    : bytes_(map_record::kMagic), checksum_(kChecksumStart) {
  append(map_record::kVersion, &bytes_);
  std::string section;
  append(
      map_record::Header{places.vocabulary, places.pattern, static_cast<std::uint32_t>(keyframes),
                         static_cast<std::uint32_t>(loops)},
      &section);
  addSection(section);
}

void MapWriter::addSection(const std::string& section) {
  checksum_ = checksum(section.data(), section.size(), checksum_);
  append(static_cast<std::uint64_t>(section.size()), &bytes_);
  bytes_ += section;
  append(checksum_, &bytes_);
}

void MapWriter::addKeyframe(const KeyframeVertex& vertex, const KeyframeView* view,
                            const std::vector<unsigned char>& picture) {
  static const KeyframeView kNone;
  const KeyframeView& shown = view == nullptr ? kNone : *view;
  map_record::Keyframe record{};
  record.stamp = vertex.stamp;
  record.sequence = static_cast<std::uint32_t>(vertex.sequence);
  record.has_view = view == nullptr ? 0 : 1;
  record.features = static_cast<std::uint32_t>(shown.features.size());
  record.points = static_cast<std::uint32_t>(shown.points.size());
  record.picture = static_cast<std::uint32_t>(picture.size());
  record.T_wb = toRecord(vertex.T_wb);
  record.T_mb = toRecord(vertex.T_mb);
  record.T_bc = toRecord(shown.T_bc);
  record.R_wb = toRecord(shown.R_wb);
  record.pixel_angle = shown.pixel_angle;
  std::string section;
  append(record, &section);
  for (const ViewFeature& feature : shown.features) append(toRecord(feature), &section);
  for (const ViewPoint& point : shown.points) {
    append(map_record::Point{point.id, toRecord(point.position_b)}, &section);
  }
  append(picture, &section);
  addSection(section);
}

void MapWriter::addLoops(const std::vector<LoopEdge>& loops) {
  std::string section;
  for (const LoopEdge& loop : loops) append(toRecord(loop), &section);
  addSection(section);
}

void MapWriter::write(const std::string& path) const { writeTextFile(path, bytes_); }

StoredMap readMap(const std::string& path) { return MapReader(readBytes(path), path).read(); }

}  // namespace vins::pose_graph
