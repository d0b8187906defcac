#include "pose_graph/map/map_file.h"

#include <cstring>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "random_descriptors.h"
#include "synthetic_keyframes.h"
#include "temp_folder.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using testing::bytesOf;
using testing::difference;
using testing::TempFolder;
using testing::writeBytes;

constexpr PlaceModelIdentity kPlaces{0x1234, 0x5678};
// Where the sections of a file begin: magic and version; then the header's length, 24 bytes and
// checksum; then the first keyframe's length.
constexpr std::size_t kHeader = 12 + 8, kFirstKeyframe = kHeader + 24 + 8;

KeyframeView viewOf(std::int64_t id, std::size_t features, std::size_t points) {
  std::mt19937_64 random(static_cast<std::uint64_t>(id) + 1);
  KeyframeView view;
  view.id = id;
  view.R_wb = so3::exp({0.1, 0.2, 0.3});
  view.T_bc = {so3::exp({-1.2, 1.2, -1.2}), {0.1, 0.0, 0.02}};
  view.pixel_angle = 0.002;
  for (std::size_t i = 0; i < features; ++i) {
    ViewFeature feature;
    feature.descriptor = testing::randomDescriptor(&random);
    feature.pixel = {static_cast<float>(i), 7.5F};
    feature.bearing = Eigen::Vector3f(0.01F * static_cast<float>(i), 0.1F, 1.0F).normalized();
    feature.point = i < points ? static_cast<int>(i) : -1;
    view.features.push_back(feature);
  }
  for (std::size_t i = 0; i < points; ++i) {
    view.points.push_back({static_cast<std::int64_t>(900 + i), {1.0, 2.0, 0.1 * double(i)}});
  }
  return view;
}

/// Eight keyframes of two runs, the last without view; pictures of the first three; two loops.
StoredMap exampleMap(std::size_t features = 40, std::size_t points = 9) {
  const testing::SyntheticKeyframes run(8, 20, 0.01, 1);
  StoredMap map;
  map.places = kPlaces;
  for (std::int64_t id = 0; id < 8; ++id) {
    MapKeyframe keyframe;
    const Pose& T_wb = run.odometry[static_cast<std::size_t>(id)];
    keyframe.vertex = {id, id < 5 ? 0 : 1, 1'000'000 * (id + 1), T_wb,
                       Pose(yawRotation(0.5), {1.0, 2.0, 3.0}) * T_wb};
    if (id < 7) keyframe.view = viewOf(id, features, points);
    if (id < 3) keyframe.picture.assign(100, static_cast<unsigned char>(id));
    map.keyframes.push_back(std::move(keyframe));
  }
  for (const std::int64_t query : {4, 6}) {
    LoopEdge loop = run.loop(1, static_cast<std::size_t>(query));
    loop.inliers = 33;
    loop.query_stamp = 1'000'000 * (query + 1);
    loop.covariance = 0.01 * Eigen::Matrix<double, 6, 6>::Identity();
    loop.covariance(0, 4) = 0.001;
    map.loops.push_back(loop);
  }
  return map;
}

MapWriter writerOf(const StoredMap& map) {
  MapWriter writer(map.places, map.keyframes.size(), map.loops.size());
  for (const MapKeyframe& keyframe : map.keyframes) {
    writer.addKeyframe(keyframe.vertex, keyframe.view ? &*keyframe.view : nullptr,
                       keyframe.picture);
  }
  writer.addLoops(map.loops);
  return writer;
}

class MapFile : public ::testing::Test {
 protected:
  /// What is wrong with these bytes as a map; "" where nothing is.
  std::string errorOf(const std::string& bytes) const {
    const std::string path = folder_.file("broken.map");
    writeBytes(path, bytes);
    try {
      readMap(path);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find(path), 0u) << error.what();
      return error.what();
    }
    return "";
  }

  std::string errorOf(const StoredMap& map) const { return errorOf(writerOf(map).bytes()); }

  const TempFolder folder_{"map_file_test"};
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

template <typename Number>
void put(const Number& number, std::size_t at, std::string* bytes) {
  std::memcpy(bytes->data() + at, &number, sizeof(Number));
}

TEST_F(MapFile, GivesBackWhatWasWritten) {
  const StoredMap map = exampleMap();
  const std::string path = folder_.file("new/folder/a.map");
  writerOf(map).write(path);
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  const StoredMap read = readMap(path);
  EXPECT_TRUE(read.places == map.places);
  ASSERT_EQ(read.keyframes.size(), map.keyframes.size());
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const MapKeyframe& expected = map.keyframes[i];
    const MapKeyframe& keyframe = read.keyframes[i];
    EXPECT_EQ(keyframe.vertex.id, expected.vertex.id);
    EXPECT_EQ(keyframe.vertex.sequence, expected.vertex.sequence);
    EXPECT_EQ(keyframe.vertex.stamp, expected.vertex.stamp);
    // All numbers are written whole.
    EXPECT_EQ(keyframe.vertex.T_wb.matrix(), expected.vertex.T_wb.matrix());
    EXPECT_EQ(keyframe.vertex.T_mb.matrix(), expected.vertex.T_mb.matrix());
    EXPECT_EQ(keyframe.picture, expected.picture);
    ASSERT_EQ(keyframe.view.has_value(), expected.view.has_value());
  }
  ASSERT_EQ(read.loops.size(), 2u);
  EXPECT_EQ(read.loops[1].query_id, 6);
  EXPECT_EQ(read.loops[1].old_id, 1);
  EXPECT_EQ(read.loops[1].inliers, 33);
  EXPECT_EQ(read.loops[1].query_stamp, map.loops[1].query_stamp);
  EXPECT_EQ(read.loops[1].T_old_query.matrix(), map.loops[1].T_old_query.matrix());
  EXPECT_EQ(read.loops[1].covariance, map.loops[1].covariance) << "row by row";
}

TEST_F(MapFile, ViewsComeBackWhole) {
  const StoredMap map = exampleMap();
  writerOf(map).write(folder_.file("a.map"));
  const KeyframeView expected = *map.keyframes[3].view;
  const KeyframeView view = readMap(folder_.file("a.map")).keyframes[3].view.value();
  EXPECT_EQ(view.id, 3);
  EXPECT_EQ(view.R_wb.coeffs(), expected.R_wb.coeffs());
  EXPECT_EQ(view.T_bc.matrix(), expected.T_bc.matrix());
  EXPECT_EQ(view.pixel_angle, expected.pixel_angle);
  ASSERT_EQ(view.features.size(), expected.features.size());
  for (std::size_t i = 0; i < view.features.size(); ++i) {
    EXPECT_EQ(view.features[i].descriptor, expected.features[i].descriptor);
    EXPECT_EQ(view.features[i].pixel, expected.features[i].pixel);
    EXPECT_EQ(view.features[i].bearing, expected.features[i].bearing);
    EXPECT_EQ(view.features[i].point, expected.features[i].point);
  }
  ASSERT_EQ(view.points.size(), expected.points.size());
  EXPECT_EQ(view.points[8].id, expected.points[8].id);
  EXPECT_EQ(view.points[8].position_b, expected.points[8].position_b);
}

TEST_F(MapFile, AKeyframeTakesLessThanSixtyKilobytes) {
  // As many as there are at most: 150 tracked points, and 500 corners besides.
  const std::size_t bytes = writerOf(exampleMap(650, 150)).bytes().size();
  EXPECT_LT(bytes / 7, 60'000u);
  EXPECT_GT(bytes / 7, 650u * 32u) << "descriptors alone take so much";
}

TEST_F(MapFile, DamagedFilesAreRefusedEachWithItsPlace) {
  const std::string whole = writerOf(exampleMap()).bytes();
  ASSERT_EQ(errorOf(whole), "");
  std::mt19937_64 random(8);
  for (int i = 0; i < 25; ++i) {
    const std::size_t length = random() % whole.size();
    const std::string error = errorOf(whole.substr(0, length));
    EXPECT_TRUE(contains(error, "at byte ")) << "cut at " << length << ": " << error;
  }
  for (int i = 0; i < 25; ++i) {
    std::string flipped = whole;
    const std::size_t at = random() % whole.size();
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (random() % 8)));
    const std::string error = errorOf(flipped);
    EXPECT_TRUE(contains(error, "at byte ")) << "flipped in byte " << at << ": " << error;
  }
}

TEST_F(MapFile, EveryByteOfTheHeaderCounts) {
  const std::string whole = writerOf(exampleMap(2, 1)).bytes();
  for (std::size_t at = 0; at < kFirstKeyframe + 16; ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string flipped = whole;
      flipped[at] = static_cast<char>(flipped[at] ^ (1 << bit));
      EXPECT_NE(errorOf(flipped), "") << "bit " << bit << " of byte " << at;
    }
  }
}

TEST_F(MapFile, TheMessageTellsWhatIsWrong) {
  const std::string whole = writerOf(exampleMap()).bytes();
  std::string other = whole;
  put(std::uint32_t{2}, 8, &other);
  EXPECT_TRUE(
      contains(errorOf(other), "at byte 12: version is 2, of a newer program; readable: 1"));
  EXPECT_TRUE(contains(errorOf("# TUM\n1 2 3 4 5 6 7 8\n"), "is no map of this program"));
  EXPECT_TRUE(contains(errorOf("VINSVOCB" + whole.substr(8)), "is no map of this program"));
  EXPECT_TRUE(contains(errorOf(""), "is no map of this program"));
  EXPECT_TRUE(contains(errorOf(whole + "x"), "1 bytes too many"));
  other = whole;
  other[kFirstKeyframe + 100] = static_cast<char>(other[kFirstKeyframe + 100] + 1);
  EXPECT_TRUE(contains(errorOf(other), "keyframe 0: at byte " + std::to_string(kFirstKeyframe + 8)))
      << errorOf(other);
  EXPECT_TRUE(contains(errorOf(other), "the checksum does not fit"));
  EXPECT_TRUE(contains(errorOf(whole.substr(0, whole.size() - 9)), "loops: "))
      << "the last section";
  EXPECT_THROW(readMap(folder_.file("missing.map")), InputError);
  EXPECT_THROW(readMap(folder_.file("")), InputError) << "a folder";
}

TEST_F(MapFile, AMissingSectionIsNoticed) {
  const std::string whole = writerOf(exampleMap()).bytes();
  std::uint64_t length = 0;
  std::memcpy(&length, whole.data() + kFirstKeyframe, sizeof(length));
  const std::size_t next = kFirstKeyframe + 8 + length + 8;
  const std::string without = whole.substr(0, kFirstKeyframe) + whole.substr(next);
  EXPECT_TRUE(contains(errorOf(without), "keyframe 0")) << errorOf(without);
}

TEST_F(MapFile, CountsAskForNoMoreMemoryThanTheFileHasBytes) {
  // Checksums fit: who writes such files means it.
  const MapWriter boast(kPlaces, 0xffffffffU, 0xffffffffU);
  EXPECT_TRUE(contains(errorOf(boast.bytes()), "too short for 4294967295 keyframes"));
  StoredMap map = exampleMap();
  MapWriter loops(map.places, 1, 0xffffffffU);
  loops.addKeyframe(map.keyframes[0].vertex, nullptr, {});
  loops.addLoops({});
  EXPECT_TRUE(contains(errorOf(loops.bytes()), "4294967295 x 368 bytes were to come, 0 are there"));
  EXPECT_TRUE(contains(errorOf(MapWriter(kPlaces, 0, 0).bytes()), "no keyframe"));
}

TEST_F(MapFile, WhatMeansNothingIsRefused) {
  const auto errorAfter = [this](const std::function<void(StoredMap*)>& change) {
    StoredMap map = exampleMap();
    change(&map);
    return errorOf(map);
  };
  EXPECT_TRUE(
      contains(errorAfter([](StoredMap* map) { map->loops[0].old_id = 8; }), "a loop's end"));
  EXPECT_TRUE(
      contains(errorAfter([](StoredMap* map) { map->loops[0].old_id = 4; }), "a loop's end"));
  EXPECT_TRUE(contains(errorAfter([](StoredMap* map) { map->loops[0].covariance(2, 2) = NAN; }),
                       "covariance"));
  EXPECT_TRUE(contains(errorAfter([](StoredMap* map) { map->keyframes[2].vertex.stamp = 5; }),
                       "keyframe 2"));
  EXPECT_TRUE(contains(
      errorAfter([](StoredMap* map) { map->keyframes[2].vertex.T_mb.position.x() = INFINITY; }),
      "T_mb is not finite"));
  EXPECT_TRUE(contains(
      errorAfter([](StoredMap* map) { map->keyframes[2].vertex.T_wb.rotation.coeffs() *= 2.0; }),
      "T_wb has a quaternion of length 2"));
  EXPECT_TRUE(
      contains(errorAfter([](StoredMap* map) { map->keyframes[1].view->features[3].point = 9; }),
               "point 9 of 9"));
  EXPECT_TRUE(contains(
      errorAfter([](StoredMap* map) { map->keyframes[1].view->features[3].bearing.setZero(); }),
      "a feature's place"));
  EXPECT_TRUE(
      contains(errorAfter([](StoredMap* map) { map->keyframes[1].view->pixel_angle = -1.0; }),
               "a pixel has no angle"));
}

TEST_F(MapFile, WhatCannotBeWrittenLeavesTheOldFile) {
  const std::string path = folder_.file("a.map");
  writeBytes(path, "old");
  // Where the file's aside name is taken by a folder, nothing can be written.
  std::filesystem::create_directories(path + ".part");
  EXPECT_THROW(writerOf(exampleMap()).write(path), InputError);
  EXPECT_EQ(bytesOf(path), "old");
  EXPECT_THROW(writerOf(exampleMap()).write(path + "/b.map"), InputError) << "no folder";
  EXPECT_EQ(bytesOf(path), "old");
}

}  // namespace
}  // namespace vins::pose_graph
