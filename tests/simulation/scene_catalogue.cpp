#include "simulation/scene_catalogue.h"

#include <algorithm>
#include <cmath>

#include "simulation/furnishing.h"
#include "simulation/household_scene.h"
#include "simulation/scene_builder.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr Finish kRoomWalls{TextureStyle::kPlaster, 200.0};
constexpr Finish kHallWalls{TextureStyle::kBricks, 110.0};

AlignedBox3d boxAround(double half_x, double half_y, double low, double high) {
  return {Vector3d(-half_x, -half_y, low), Vector3d(half_x, half_y, high)};
}

Pose turnedAt(const Vector3d& position, double yaw) {
  return {so3::exp(Vector3d(0.0, 0.0, yaw)), position};
}

Furniture roomFurniture() {
  Furniture furniture;
  furniture.blocks = 16;
  furniture.smallest_half = {0.15, 0.15, 0.2};
  furniture.largest_half = {0.6, 0.45, 1.0};
  furniture.boards = 5;
  furniture.posters = 18;
  return furniture;
}

Furniture hallFurniture() {
  Furniture furniture;
  furniture.blocks = 34;
  furniture.smallest_half = {0.3, 0.3, 0.3};
  furniture.largest_half = {1.5, 1.0, 1.6};
  furniture.texels_per_m = 160.0;
  furniture.boards = 8;
  furniture.posters = 26;
  return furniture;
}

Scene makeRoom(std::uint64_t seed) {
  SceneBuilder builder(seed);
  const AlignedBox3d interior = boxAround(4.0, 3.0, 0.0, 4.0);
  ReservedSpace reserved;
  reserved.boxes = {boxAround(2.2, 1.4, 0.3, 3.2)};
  builder.beginSection("room");
  builder.addShell(interior, {TextureStyle::kTiles, 200.0}, kRoomWalls,
                   {TextureStyle::kPlaster, 128.0});
  hangLamps(builder, interior, 2, 2);
  furnish(builder, interior, roomFurniture(), reserved);
  return builder.build(interior);
}

Scene makeHall(std::uint64_t seed) {
  SceneBuilder builder(seed);
  const AlignedBox3d interior = boxAround(10.0, 7.0, 0.0, 6.0);
  ReservedSpace reserved;
  reserved.boxes = {boxAround(8.0, 2.8, 0.3, 5.0)};
  builder.beginSection("hall");
  builder.addShell(interior, {TextureStyle::kTiles, 110.0}, kHallWalls,
                   {TextureStyle::kBoards, 100.0});
  hangLamps(builder, interior, 4, 3);
  for (const double x : {-7.0, -2.4, 2.4, 7.0}) {
    for (const double y : {-3.4, 3.4}) {
      builder.addBlock(turnedAt({x, y, 3.0}, 0.0), {0.25, 0.25, 3.0}, {TextureStyle::kBricks, 200});
    }
  }
  furnish(builder, interior, hallFurniture(), reserved);
  return builder.build(interior);
}

/// One side of the corridor: x along it, the outer wall at y = 1.25, the block's wall at -1.25.
/// Floor and ceiling reach `half_floor` to both sides.
void addCorridorSide(SceneBuilder& builder, double half_outer, double half_floor) {
  const double half_inner = half_outer - 2.5, half_width = 1.25, height = 3.0;
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const Finish wall{TextureStyle::kPlaster, 128.0}, brick{TextureStyle::kBricks, 128.0};
  builder.addPanel({0, half_width, 0.5 * height}, x, z, half_outer, 0.5 * height, wall);
  builder.addPanel({0, -half_width, 0.5 * height}, -x, z, half_inner, 0.5 * height, brick);
  builder.addPanel({0, 0, 0}, x, y, half_floor, half_width, {TextureStyle::kTiles, 128.0});
  builder.addPanel({0, 0, height}, y, x, half_width, half_floor, {TextureStyle::kBoards, 128.0});
  for (double lamp = 2.0 - half_inner; lamp < half_inner; lamp += 4.0) {
    builder.addLight({lamp, 0.0, height - 0.1}, 0.35, 2.0);
  }
  Random& random = builder.random();
  for (double at = -half_inner + 0.5; at < half_inner; at += random.uniform(1.2, 2.2)) {
    // Cupboards, pipes and boxes along the outer wall, as deep as the free space allows.
    const Vector3d half(random.uniform(0.1, 0.5), random.uniform(0.05, 0.18),
                        random.uniform(0.2, 1.3));
    builder.addBlock({Eigen::Quaterniond::Identity(), {at, half_width - half.y(), half.z()}}, half,
                     {TextureStyle::kClutter, 256.0});
  }
  for (double at = -half_inner + 0.8; at < half_inner; at += random.uniform(1.0, 2.0)) {
    builder.addPanel({at, 0.01 - half_width, random.uniform(1.1, 2.0)}, -x, z,
                     random.uniform(0.2, 0.45), random.uniform(0.2, 0.6),
                     {TextureStyle::kPrint, 400.0});
  }
}

Scene makeCorridor(std::uint64_t seed, bool alike) {
  SceneBuilder builder(seed);
  const double half_x = 10.0, half_y = 7.0, half_width = 1.25;
  builder.beginSection("side 0", turnedAt({0, half_y - half_width, 0}, 0.0));
  addCorridorSide(builder, half_x, half_x);
  builder.beginSection("side 1", turnedAt({half_width - half_x, 0, 0}, 0.5 * M_PI));
  addCorridorSide(builder, half_y, half_y - 2.0 * half_width);
  builder.beginSection(alike ? "side 0" : "side 2", turnedAt({0, half_width - half_y, 0}, M_PI));
  addCorridorSide(builder, half_x, half_x);
  builder.beginSection("side 3", turnedAt({half_x - half_width, 0, 0}, 1.5 * M_PI));
  addCorridorSide(builder, half_y, half_y - 2.0 * half_width);
  const Scene sides = builder.build(boxAround(half_x, half_y, 0.0, 3.0));
  std::vector<Solid> solids = sides.solids();
  solids.push_back({Pose(Eigen::Quaterniond::Identity(), {0.0, 0.0, 1.5}),
                    {half_x - 2.0 * half_width, half_y - 2.0 * half_width, 1.5}});
  return Scene(sides.panels(), solids, {}, sides.interior());
}

Scene makeYard(std::uint64_t seed) {
  SceneBuilder builder(seed);
  const AlignedBox3d interior = boxAround(40.0, 40.0, 0.0, 30.0);
  ReservedSpace reserved;
  reserved.boxes = {boxAround(8.0, 8.0, 0.0, 12.0)};
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  builder.beginSection("sky");
  builder.addShell(boxAround(300.0, 300.0, -1.0, 150.0), {TextureStyle::kGround, 1.0},
                   {TextureStyle::kClouds, 1.6, 1.0}, {TextureStyle::kClouds, 1.6, 1.0});
  builder.beginSection("ground");
  builder.addPanel({0, 0, 0}, x, y, 40.0, 40.0, {TextureStyle::kGround, 25.0});
  builder.addPanel({0, 0, 0.005}, x, y, 10.0, 10.0, {TextureStyle::kGround, 100.0});
  for (int side = 0; side < 4; ++side) {
    builder.beginSection("wall " + std::to_string(side), turnedAt(Vector3d::Zero(), side * M_PI_2));
    const double height = builder.random().uniform(5.0, 11.0);
    builder.addPanel({0, 40.0, 0.5 * height}, x, z, 40.0, 0.5 * height,
                     {TextureStyle::kBricks, 25.0});
  }
  builder.beginSection("things");
  builder.addLight({200.0, 120.0, 250.0}, 0.45, 1000.0);
  Furniture things;
  things.blocks = 45;
  things.smallest_half = {0.5, 0.5, 0.5};
  things.largest_half = {3.0, 1.3, 1.5};
  things.texels_per_m = 80.0;
  furnish(builder, boxAround(30.0, 30.0, 0.0, 30.0), things, reserved);
  return builder.build(interior);
}

}  // namespace

std::vector<std::string> sceneNames() {
  return {"room", "hall", "corridor", "corridor_alike", "yard", "household"};
}

Scene makeScene(const std::string& name, std::uint64_t seed) {
  if (name == "room") return makeRoom(seed);
  if (name == "hall") return makeHall(seed);
  if (name == "corridor") return makeCorridor(seed, false);
  if (name == "corridor_alike") return makeCorridor(seed, true);
  if (name == "yard") return makeYard(seed);
  if (name == "household") return makeHousehold(seed);
  throw InputError("scene: found '" + name +
                   "'; allowed: room, hall, corridor, corridor_alike, yard, household");
}

Scene sceneFittedTo(const std::vector<Vector3d>& positions_w, std::uint64_t seed, FittedStyle style,
                    double clearance) {
  if (positions_w.empty()) throw InputError("scene: found no positions; allowed: at least one");
  AlignedBox3d interior;
  for (const Vector3d& p_w : positions_w) interior.extend(p_w);
  const bool hall = style == FittedStyle::kHall;
  const double beyond = std::max(hall ? 4.0 : 2.0, clearance + 1.0);
  interior.min() -= Vector3d(beyond, beyond, std::max(1.0, clearance));
  interior.max() += Vector3d(beyond, beyond, std::max(hall ? 2.5 : 1.2, clearance + 0.2));
  const ReservedSpace reserved{{}, positions_w, clearance};
  SceneBuilder builder(seed);
  builder.beginSection("fitted");
  builder.addShell(interior, {TextureStyle::kTiles, hall ? 110.0 : 200.0},
                   hall ? kHallWalls : kRoomWalls, {TextureStyle::kBoards, 100.0});
  hangLamps(builder, interior, hall ? 4 : 2, hall ? 3 : 2);
  furnish(builder, interior, hall ? hallFurniture() : roomFurniture(), reserved);
  return builder.build(interior);
}

MovingObject makeSwingingBlock(const Vector3d& middle_w, const Vector3d& swing, double period_s,
                               const Vector3d& half, std::uint64_t seed) {
  TextureOptions options;
  options.style = TextureStyle::kClutter;
  const auto texture =
      std::make_shared<const Texture>(makeNaturalTexture(seed, "swinging block", options));
  MovingObject object;
  object.panels = blockPanels(half);
  for (Panel& panel : object.panels) {
    panel.texture = texture;
    panel.texels_per_m = options.texels_per_m;
    panel.light = 0.8;
  }
  object.pose_at = [=](double t_s) {
    return Pose(Eigen::Quaterniond::Identity(),
                middle_w + std::sin(2.0 * M_PI * t_s / period_s) * swing);
  };
  const Vector3d reach = half + swing.cwiseAbs();
  object.reach = AlignedBox3d(middle_w - reach, middle_w + reach);
  return object;
}

}  // namespace vins::simulation
