#include "simulation/household_scene.h"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "simulation/scene_builder.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double kHalf = kHouseholdHalfSide;
constexpr double kHeight = 2.5;
constexpr double kTexels = 200.0;      ///< of large surfaces [1/m]
constexpr double kFineTexels = 400.0;  ///< of small things [1/m]

Finish painted(double luminance) { return {TextureStyle::kPaint, kTexels, 0.0, luminance}; }
Finish cloth(double luminance) { return {TextureStyle::kFabric, kTexels, 0.0, luminance}; }
Finish lacquered(double luminance, double gloss = 0.25) {
  Finish finish{TextureStyle::kLacquer, kTexels, 0.0, luminance};
  finish.gloss = gloss;
  return finish;
}
/// Bedding: plain, or printed with a pattern.
Finish bedding(Random& random, double luminance) {
  const bool patterned = random.uniform() < 0.35;
  return patterned ? Finish{TextureStyle::kClutter, kFineTexels} : cloth(luminance);
}
/// Something small with structure of its own: a book, a box, a mug.
Finish thing(Random& random) {
  const bool print = random.uniform() < 0.5;
  return {print ? TextureStyle::kPrint : TextureStyle::kLacquer, kFineTexels, 0.0,
          random.uniform(0.05, 0.85)};
}

Pose at(double x, double y, double z, const Vector3d& turn = Vector3d::Zero()) {
  return {so3::exp(turn), {x, y, z}};
}

/// A room's furniture. Each piece is placed in the frame of its wall: x along the wall, the wall at
/// y = kHalf, the room's middle at the origin.
class Household {
 public:
  explicit Household(std::uint64_t seed) : builder_(seed) {}

  Scene build();

 private:
  using Furnish = void (Household::*)();

  Random& random() { return builder_.random(); }
  double vary(double value, double by) { return value + random().uniform(-by, by); }
  void block(const Pose& pose, const Vector3d& half, const Finish& finish) {
    builder_.addBlock(pose, half, finish);
  }
  /// A flat rectangle, `off` [m] before the wall.
  void onWall(double x, double z, double half_x, double half_z, double off, const Finish& finish) {
    builder_.addPanel({x, kHalf - off, z}, Vector3d::UnitX(), Vector3d::UnitZ(), half_x, half_z,
                      finish);
  }

  void addRoom();
  void addLights();
  void addJoints();
  void addSkirting();
  void addMarks();
  void addBedside();
  void addBedding(double x, double y);
  void addNightstand(double x);
  void addWindowside();
  void addDeskside();
  void addChair(double x, double y);
  void addDoorside();
  void addPicture(double x);
  void addWallDecoration(double x);
  void addShelf(double x, double z);
  void addThings(double x, double y, double top, double half_x, double half_y, int count);
  void addFloorThings();

  SceneBuilder builder_;
  bool day_ = true;
  double wall_ = 0.45;  ///< luminance of the walls
};

Scene Household::build() {
  builder_.beginSection("room");
  day_ = random().uniform() < 0.6;
  wall_ = random().uniform(0.36, 0.55);
  std::array<Furnish, 4> sides = {&Household::addBedside, &Household::addWindowside,
                                  &Household::addDeskside, &Household::addDoorside};
  for (std::size_t i = 3; i > 0; --i) {
    std::swap(sides[i],
              sides[static_cast<std::size_t>(random().uniform(0.0, static_cast<double>(i) + 1.0))]);
  }
  // Lamps first: glossy surfaces mirror what is known of them.
  for (int side = 0; side < 4; ++side) {
    if (sides[static_cast<std::size_t>(side)] != &Household::addWindowside) continue;
    builder_.beginSection("lights", at(0, 0, 0, {0, 0, side * M_PI_2}));
    addLights();
  }
  addRoom();
  for (int side = 0; side < 4; ++side) {
    builder_.beginSection("side " + std::to_string(side), at(0, 0, 0, {0, 0, side * M_PI_2}));
    addSkirting();
    addMarks();
    (this->*sides[static_cast<std::size_t>(side)])();
  }
  builder_.beginSection("floor");
  addFloorThings();
  return builder_.build(AlignedBox3d(Vector3d(-kHalf, -kHalf, 0), Vector3d(kHalf, kHalf, kHeight)));
}

void Household::addLights() {
  builder_.setAmbientLight(day_ ? 0.30 : 0.22);
  const Vector3d window(0.0, kHalf - 0.2, 1.45), lamp(vary(0.0, 0.8), -0.9, kHeight - 0.1);
  builder_.addLight(day_ ? window : lamp, day_ ? 1.0 : 0.7, 1.6);
  builder_.setMirroredLamp(day_ ? window : lamp);
}

void Household::addRoom() {
  builder_.beginSection("shell");
  Finish floor{TextureStyle::kWood, kTexels, 0.0, vary(0.22, 0.08)};
  floor.gloss = 0.12;
  floor.gloss_width_m = 0.25;
  builder_.addShell(AlignedBox3d(Vector3d(-kHalf, -kHalf, 0), Vector3d(kHalf, kHalf, kHeight)),
                    floor, painted(wall_), painted(wall_ + 0.12));
  // The lamp at the ceiling, by night too bright for the sensor.
  const double glow = day_ ? 0.8 : 4.0;
  builder_.addPanel({0.0, 0.0, kHeight - 0.01}, Vector3d::UnitY(), Vector3d::UnitX(), 0.18, 0.18,
                    {TextureStyle::kPaint, kTexels, glow, 0.9});
}

void Household::addSkirting() { onWall(0.0, 0.04, kHalf, 0.04, 0.012, painted(wall_ - 0.10)); }

/// Hooks, stickers, stains and a cable.
void Household::addMarks() {
  for (int i = 0; i < 7; ++i) {
    const double size = random().uniform(0.008, 0.03);
    const double shade = wall_ + (random().uniform() < 0.5 ? 0.14 : -0.2);
    onWall(vary(0.0, 1.9), vary(1.2, 0.9), size, random().uniform(0.5, 1.5) * size,
           0.003 + 0.0005 * i, painted(shade));
  }
  double x = vary(0.0, 1.5), z = 0.3;
  for (int i = 0; i < 8; ++i) {
    const double next_x = x + vary(0.0, 0.12), next_z = z + vary(-0.02, 0.06);
    const Vector3d way(next_x - x, 0.0, next_z - z), along = way.normalized();
    builder_.addPanel({0.5 * (x + next_x), kHalf - 0.008, 0.5 * (z + next_z)}, along,
                      along.cross(Vector3d::UnitY()), 0.5 * way.norm(), 0.004, painted(0.75));
    x = next_x;
    z = next_z;
  }
}

void Household::addJoints() {
  for (double x = vary(-1.6, 0.2); x < kHalf; x += random().uniform(0.5, 0.9)) {
    onWall(x, 0.5 * kHeight, 0.004, 0.5 * kHeight, 0.002, painted(0.45 * wall_));
  }
}

void Household::addPicture(double x) {
  const double z = vary(1.55, 0.15), half_x = vary(0.22, 0.08), half_z = vary(0.2, 0.06);
  onWall(x, z, half_x, half_z, 0.02, lacquered(0.12));
  onWall(
      x, z, half_x - 0.03, half_z - 0.03, 0.022,
      {random().uniform() < 0.5 ? TextureStyle::kPrint : TextureStyle::kFabric, kTexels, 0.0, 0.4});
}

void Household::addWallDecoration(double x) {
  addPicture(vary(x, 0.4));
  if (random().uniform() < 0.7) addJoints();
}

/// A board on the wall with books that lean against each other.
void Household::addShelf(double x, double z) {
  const double half_x = vary(0.45, 0.1), y = kHalf - 0.12;
  block(at(x, y, z - 0.01), {half_x, 0.11, 0.01}, lacquered(0.25));
  const double end = x + 0.8 * half_x;
  for (double place = x - half_x + 0.03; place < end;) {
    const double half = vary(0.018, 0.008), height = vary(0.11, 0.03);
    const double lean = random().uniform() < 0.15 ? 0.2 : 0.0;
    block(at(place + half, y, z + height, {0, lean, 0}), {half, 0.08, height}, thing(random()));
    place += 2.0 * half + 0.003 + (lean > 0.0 ? 0.06 : 0.0);
  }
}

void Household::addThings(double x, double y, double top, double half_x, double half_y, int count) {
  for (int i = 0; i < count; ++i) {
    const Vector3d half(vary(0.05, 0.03), vary(0.04, 0.02), vary(0.04, 0.03));
    const Pose pose = at(vary(x, half_x), vary(y, half_y), top + half.z(), {0, 0, vary(0.0, M_PI)});
    block(pose, half, thing(random()));
  }
}

void Household::addBedding(double x, double y) {
  for (const double side : {-0.22, 0.22}) {
    block(at(vary(x - 0.68, 0.05), y + side, vary(0.57, 0.02),
             {vary(0.0, 0.15), vary(-0.25, 0.15), vary(0.0, 0.3)}),
          {0.17, 0.22, 0.06}, bedding(random(), vary(0.6, 0.12)));
  }
  const int folds = 5 + static_cast<int>(random().uniform(0.0, 4.0));
  for (int i = 0; i < folds; ++i) {
    const Vector3d turn(vary(0.0, 0.3), vary(0.0, 0.3), vary(0.0, 1.5));
    const Vector3d half(vary(0.28, 0.1), vary(0.22, 0.08), vary(0.06, 0.02));
    block(at(vary(x + 0.2, 0.55), vary(y, 0.28), vary(0.53, 0.04), turn), half,
          bedding(random(), vary(0.45, 0.2)));
  }
}

void Household::addNightstand(double x) {
  const double y = kHalf - 0.22;
  block(at(x, y, 0.25), {0.2, 0.2, 0.25}, lacquered(0.08, 0.3));
  block(at(x, y + 0.05, 0.56), {0.03, 0.03, 0.06}, lacquered(0.1));
  const double glow = random().uniform() < 0.5 ? 2.5 : 0.5;
  block(at(x, y + 0.05, 0.70), {0.09, 0.09, 0.08}, {TextureStyle::kPaint, kTexels, glow, 0.8});
  addThings(x, y - 0.08, 0.5, 0.12, 0.09, 4);
  onWall(x, 0.75, 0.06, 0.04, 0.01, painted(0.75));
}

void Household::addBedside() {
  const double x = vary(-0.4, 0.15), y = kHalf - 0.52;
  block(at(x, y, 0.20), {1.0, 0.5, 0.20}, lacquered(0.07, 0.1));
  block(at(x, y, 0.44), {0.97, 0.47, 0.05}, cloth(vary(0.6, 0.1)));
  block(at(x - 1.03, y, 0.5), {0.03, 0.5, 0.5}, lacquered(0.08));
  addBedding(x, y);
  addThings(x + 0.2, y, 0.56, 0.7, 0.38, 11);
  addNightstand(x + 1.3);
  addWallDecoration(0.0);
}

void Household::addWindowside() {
  const double half_x = vary(0.6, 0.1), half_z = 0.55, z = 1.45;
  const double glow = day_ ? random().uniform(4.0, 8.0) : 0.06;
  onWall(0.0, z, half_x, half_z, 0.004, {TextureStyle::kClouds, kTexels, glow, 0.0});
  for (const double side : {-1.0, 0.0, 1.0}) {
    const Vector3d bar(side == 0.0 ? 0.03 : 0.05, 0.03, half_z);
    block(at(side * half_x, kHalf - 0.02, z), bar, painted(0.7));
  }
  for (const double side : {-1.0, 1.0}) {
    block(at(0.0, kHalf - 0.02, z + side * half_z), {half_x + 0.05, 0.04, 0.04}, painted(0.7));
    // By night the curtains are nearly closed.
    const double reach = day_ ? 0.28 : 0.45;
    onWall(side * (half_x + (day_ ? 0.2 : -0.1)), 1.25, reach, 1.15, 0.09,
           {TextureStyle::kCurtain, kTexels, 0.0, vary(0.28, 0.1)});
  }
  const double x = vary(0.0, 0.4);
  block(at(x, kHalf - 0.2, 0.3), {0.6, 0.18, 0.3}, lacquered(vary(0.4, 0.2)));
  addThings(x, kHalf - 0.2, 0.6, 0.5, 0.12, 9);
  addPicture(random().uniform() < 0.5 ? -1.55 : 1.55);
}

void Household::addChair(double x, double y) {
  const double turn = vary(0.0, 0.7), shade = vary(0.4, 0.15);
  const Pose T_chair = at(x, y, 0.0, {0, 0, turn});
  const Finish finish{TextureStyle::kFabric, kTexels, 0.0, shade};
  block(T_chair * at(0, 0, 0.45), {0.24, 0.24, 0.05}, finish);
  block(T_chair * at(0, -0.24, 0.68, {-0.12, 0, 0}), {0.22, 0.04, 0.2}, finish);
  block(T_chair * at(0, 0, 0.22), {0.04, 0.04, 0.2}, lacquered(0.08));
  for (const double side : {-0.26, 0.26}) {
    block(T_chair * at(side, 0, 0.6), {0.03, 0.18, 0.02}, lacquered(0.1));
  }
}

void Household::addDeskside() {
  const double x = vary(0.0, 0.3), y = kHalf - 0.36, top = 0.74;
  block(at(x, y, top - 0.02), {0.75, 0.34, 0.02}, lacquered(vary(0.18, 0.08), 0.3));
  for (const double side : {-0.7, 0.7}) {
    block(at(x + side, y, 0.36), {0.02, 0.3, 0.35}, lacquered(0.1));
  }
  for (const double side : {-0.36, 0.36}) {
    const Pose T_screen = at(x + side, y + 0.14, 0.0, {0, 0, -0.35 * side});
    block(T_screen * at(0, 0, top + 0.28), {0.31, 0.015, 0.18}, lacquered(0.03, 0.35));
    block(T_screen * at(0, 0.03, top + 0.06), {0.04, 0.02, 0.06}, lacquered(0.05));
  }
  block(at(x, y - 0.18, top + 0.012), {0.2, 0.07, 0.012},
        {TextureStyle::kPrint, kFineTexels, 0.0, 0.0});
  addThings(x, y - 0.08, top, 0.68, 0.24, 12);
  addShelf(vary(x, 0.5), 1.62);
  addWallDecoration(random().uniform() < 0.5 ? -1.4 : 1.4);
  addChair(vary(x, 0.3), 1.25);
}

void Household::addDoorside() {
  const double door = vary(-0.9, 0.2);
  onWall(door, 1.0, 0.45, 1.0, 0.003, painted(wall_ + 0.06));
  for (const double side : {-1.0, 1.0}) {
    block(at(door + side * 0.48, kHalf - 0.01, 1.02), {0.035, 0.02, 1.02}, painted(wall_ + 0.1));
  }
  block(at(door, kHalf - 0.01, 2.04), {0.51, 0.02, 0.035}, painted(wall_ + 0.1));
  block(at(door + 0.38, kHalf - 0.05, 1.02), {0.06, 0.02, 0.012}, lacquered(0.6, 0.8));
  onWall(door + 0.65, 1.15, 0.04, 0.04, 0.01, painted(0.75));
  addPicture(vary(0.25, 0.1));
  // A wardrobe of two doors, in the dark corner.
  const double x = vary(1.2, 0.1), shade = vary(0.3, 0.15);
  block(at(x, kHalf - 0.28, 1.0), {0.5, 0.28, 1.0}, lacquered(shade, 0.2));
  onWall(x, 1.0, 0.003, 0.98, 0.565, painted(0.4 * shade));
  block(at(x - 0.06, kHalf - 0.575, 1.0), {0.01, 0.01, 0.1}, lacquered(0.6, 0.8));
  onWall(vary(0.1, 0.2), 0.3, 0.06, 0.04, 0.012, painted(0.75));
  if (random().uniform() < 0.6) {
    block(at(vary(0.2, 0.1), kHalf - 0.1, 1.3, {0, 0, 0}), {0.14, 0.06, 0.35},
          cloth(vary(0.25, 0.15)));
  }
}

void Household::addFloorThings() {
  for (int i = 0; i < 13; ++i) {
    const Vector3d half(vary(0.12, 0.04), vary(0.08, 0.03), vary(0.02, 0.015));
    block(at(vary(0.0, 1.3), vary(0.0, 1.3), half.z(), {0, 0, vary(0.0, M_PI)}), half,
          i == 0 ? painted(0.7) : thing(random()));
  }
  if (random().uniform() < 0.5) {
    builder_.addPanel({vary(0.0, 0.3), vary(0.0, 0.3), 0.004}, Vector3d::UnitX(), Vector3d::UnitY(),
                      0.8, 0.55, bedding(random(), vary(0.3, 0.15)));
  }
}

}  // namespace

Scene makeHousehold(std::uint64_t seed) { return Household(seed).build(); }

}  // namespace vins::simulation
