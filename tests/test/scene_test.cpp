#include "simulation/scene.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "simulation/scene_builder.h"
#include "simulation/scene_catalogue.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

std::shared_ptr<const Texture> plain(double luminance) {
  return std::make_shared<const Texture>(cv::Mat(4, 4, CV_32FC1, cv::Scalar(luminance)));
}

/// A 2 x 1 m panel at x = 5, seen from the origin, of luminance 0.25.
Panel panelAhead() {
  Panel panel;
  panel.centre = {5.0, 0.0, 0.0};
  panel.axis_s = -Vector3d::UnitY();
  panel.axis_t = Vector3d::UnitZ();
  panel.half_s = 1.0;
  panel.half_t = 0.5;
  panel.texture = plain(0.25);
  return panel;
}

Scene sceneOf(const std::vector<Panel>& panels) {
  return Scene(panels, {}, {}, AlignedBox3d(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)));
}

Vector3d anyDirection(Random& random) { return random.normal3().normalized(); }

TEST(Scene, RayMeetsAPanelWhereItShould) {
  const Scene scene = sceneOf({panelAhead()});
  const auto ahead = scene.intersect(Vector3d::Zero(), Vector3d::UnitX());
  ASSERT_TRUE(ahead);
  EXPECT_DOUBLE_EQ(ahead->distance, 5.0);
  EXPECT_NEAR(ahead->luminance, 0.25, 1e-4);
  EXPECT_EQ(ahead->panel, 0);
  EXPECT_EQ(ahead->object, -1);
  const Vector3d slanted = Vector3d(5.0, 0.9, -0.4).normalized();
  EXPECT_NEAR(scene.intersect(Vector3d::Zero(), slanted)->distance, std::sqrt(25.97), 1e-12);
  EXPECT_FALSE(scene.intersect(Vector3d::Zero(), Vector3d(5.0, 1.1, 0.0).normalized()));
  EXPECT_FALSE(scene.intersect(Vector3d::Zero(), Vector3d(5.0, 0.0, 0.6).normalized()));
  EXPECT_FALSE(scene.intersect(Vector3d::Zero(), -Vector3d::UnitX()));
}

TEST(Scene, PanelIsInvisibleFromBehind) {
  const Scene scene = sceneOf({panelAhead()});
  EXPECT_FALSE(scene.intersect({8.0, 0.0, 0.0}, -Vector3d::UnitX()));
}

TEST(Scene, NearerPanelHidesTheFartherOneInAnyOrder) {
  Panel near = panelAhead();
  near.centre.x() = 3.0;
  near.texture = plain(0.75);
  for (const auto& panels :
       {std::vector<Panel>{near, panelAhead()}, std::vector<Panel>{panelAhead(), near}}) {
    const auto hit = sceneOf(panels).intersect(Vector3d::Zero(), Vector3d::UnitX());
    ASSERT_TRUE(hit);
    EXPECT_DOUBLE_EQ(hit->distance, 3.0);
    EXPECT_NEAR(hit->luminance, 0.75, 1e-4);
  }
}

TEST(Scene, LightAndTextureLieWhereThePanelSays) {
  Panel panel = panelAhead();
  cv::Mat halves(64, 64, CV_32FC1, cv::Scalar(0.2));
  halves.colRange(32, 64).setTo(0.8);
  panel.texture = std::make_shared<const Texture>(halves);
  panel.texels_per_m = 32.0;
  panel.texture_origin = {32.0, 32.0};
  panel.light = 0.5;
  panel.light_t = 0.2;
  // axis_s is -y: the bright half of the texture lies at negative y.
  const Scene scene = sceneOf({panel});
  const auto luminance = [&](double y, double z) {
    return scene.intersect({0.0, y, z}, Vector3d::UnitX())->luminance;
  };
  EXPECT_NEAR(luminance(-0.5, 0.0), 0.4, 1e-4);
  EXPECT_NEAR(luminance(0.5, 0.0), 0.1, 1e-4);
  EXPECT_NEAR(luminance(0.5, 0.25), 0.2 * 0.55, 1e-4);
}

TEST(Scene, RayMeetsATurnedBlockWhereItShould) {
  SceneBuilder builder(1);
  builder.beginSection("block");
  // Turned by 45 degrees: its edge, not its face, is towards the origin.
  builder.addBlock({so3::exp(Vector3d(0, 0, M_PI / 4)), {4.0, 0.0, 0.0}}, {0.5, 0.5, 0.5},
                   {TextureStyle::kPlaster, 64.0});
  const Scene scene = builder.build(AlignedBox3d(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)));
  const double y = 1e-3;
  const auto hit = scene.intersect({0.0, y, 0.0}, Vector3d::UnitX());
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 4.0 - std::sqrt(0.5) + y, 1e-12);
  EXPECT_NEAR(scene.intersect({8.0, y, 0.0}, -Vector3d::UnitX())->distance,
              4.0 - std::sqrt(0.5) + y, 1e-12);
  EXPECT_NEAR(scene.intersect({4.0, 0.0, 3.0}, -Vector3d::UnitZ())->distance, 2.5, 1e-12);
  EXPECT_NEAR(scene.solids()[0].distanceTo({0.0, 0.0, 0.0}), 4.0 - std::sqrt(0.5), 1e-12);
  EXPECT_EQ(scene.solids()[0].distanceTo({4.1, 0.1, 0.2}), 0.0);
}

TEST(Scene, ShellIsSeenFromInsideOnAllSides) {
  SceneBuilder builder(1);
  builder.beginSection("shell");
  const AlignedBox3d box(Vector3d(-2, -3, 0), Vector3d(4, 5, 6));
  builder.addShell(box, {TextureStyle::kTiles, 32.0}, {TextureStyle::kPlaster, 32.0},
                   {TextureStyle::kBoards, 32.0});
  const Scene scene = builder.build(box);
  const Vector3d p(1.0, 1.0, 2.0);
  EXPECT_NEAR(scene.intersect(p, Vector3d::UnitX())->distance, 3.0, 1e-12);
  EXPECT_NEAR(scene.intersect(p, -Vector3d::UnitX())->distance, 3.0, 1e-12);
  EXPECT_NEAR(scene.intersect(p, Vector3d::UnitY())->distance, 4.0, 1e-12);
  EXPECT_NEAR(scene.intersect(p, -Vector3d::UnitY())->distance, 4.0, 1e-12);
  EXPECT_NEAR(scene.intersect(p, Vector3d::UnitZ())->distance, 4.0, 1e-12);
  EXPECT_NEAR(scene.intersect(p, -Vector3d::UnitZ())->distance, 2.0, 1e-12);
}

TEST(Scene, MovingBlockIsMetWhereItIsAtTheTime) {
  const MovingObject block =
      makeSwingingBlock({4.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 4.0, {0.5, 0.5, 0.5}, 1);
  const Scene scene = sceneOf({}).with(block);
  const auto distance = [&](double t_s) {
    return scene.intersect(Vector3d::Zero(), Vector3d::UnitX(), t_s)->distance;
  };
  EXPECT_NEAR(distance(0.0), 3.5, 1e-12);
  EXPECT_NEAR(distance(1.0), 4.5, 1e-12);
  EXPECT_NEAR(distance(3.0), 2.5, 1e-12);
  EXPECT_EQ(scene.intersect(Vector3d::Zero(), Vector3d::UnitX(), 1.0)->object, 0);
  EXPECT_FALSE(scene.isFree({3.0, 0.0, 0.0}, 0.1)) << "it comes there";
  EXPECT_TRUE(scene.isFree({2.0, 0.0, 0.0}, 0.1));
}

TEST(SceneCatalogue, EveryRayFromFreeSpaceMeetsSomething) {
  Random random(1, "directions");
  for (const std::string& name : sceneNames()) {
    const Scene scene = makeScene(name, 3);
    const Vector3d p_w =
        name.rfind("corridor", 0) == 0 ? Vector3d(0, 5.75, 1.5) : Vector3d(0, 0, 1.5);
    for (int i = 0; i < 500; ++i) {
      const auto hit = scene.intersect(p_w, anyDirection(random));
      ASSERT_TRUE(hit) << name;
      EXPECT_GT(hit->distance, 0.2) << name;
    }
  }
}

TEST(SceneCatalogue, DocumentedSpaceIsFree) {
  Random random(1, "places");
  const auto expectFree = [&](const Scene& scene, const Vector3d& low, const Vector3d& high) {
    for (int i = 0; i < 2000; ++i) {
      const Vector3d share(random.uniform(), random.uniform(), random.uniform());
      EXPECT_TRUE(scene.isFree(low + share.cwiseProduct(high - low), 0.0));
    }
  };
  const std::uint64_t seed = 2;
  expectFree(makeScene("room", seed), {-2.2, -1.4, 0.3}, {2.2, 1.4, 3.2});
  expectFree(makeScene("hall", seed), {-8.0, -2.8, 0.3}, {8.0, 2.8, 5.0});
  const Scene corridor = makeScene("corridor", seed);
  expectFree(corridor, {-9.6, 4.9, 0.01}, {9.6, 6.6, 2.7});
  expectFree(corridor, {-9.6, -6.6, 0.01}, {9.6, -4.9, 2.7});
  expectFree(corridor, {7.9, -6.6, 0.01}, {9.6, 6.6, 2.7});
  expectFree(corridor, {-9.6, -6.6, 0.01}, {-7.9, 6.6, 2.7});
  EXPECT_FALSE(corridor.isFree({0.0, 0.0, 1.5}, 0.0)) << "inside of the block";
  expectFree(makeScene("yard", seed), {-8.0, -8.0, 0.01}, {8.0, 8.0, 12.0});
  for (std::uint64_t household = 1; household <= 8; ++household) {
    expectFree(makeScene("household", household), {-0.95, -0.95, 0.9}, {0.95, 0.95, 2.2});
  }
}

TEST(SceneCatalogue, SeedsDifferAndRepeat) {
  const Scene a = makeScene("room", 1), b = makeScene("room", 1), c = makeScene("room", 2);
  Random random(1, "directions");
  int same = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d direction = anyDirection(random), p_w(0.0, 0.0, 1.5);
    const auto hit = a.intersect(p_w, direction);
    EXPECT_EQ(hit->luminance, b.intersect(p_w, direction)->luminance);
    same += hit->luminance == c.intersect(p_w, direction)->luminance ? 1 : 0;
  }
  EXPECT_LT(same, 5);
}

TEST(SceneCatalogue, OnlyTheAlikeCorridorHasTwoSidesThatLookTheSame) {
  const Scene corridor = makeScene("corridor", 1), alike = makeScene("corridor_alike", 1);
  Random random(1, "directions");
  int same_in_corridor = 0, same_in_alike = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d p_w(1.0, 5.75, 1.5), direction = anyDirection(random);
    const Vector3d turned_p(-1.0, -5.75, 1.5);
    const Vector3d turned(-direction.x(), -direction.y(), direction.z());
    const auto same = [&](const Scene& scene) {
      const double here = scene.intersect(p_w, direction)->luminance;
      return std::abs(here - scene.intersect(turned_p, turned)->luminance) < 1e-3;
    };
    same_in_corridor += same(corridor) ? 1 : 0;
    same_in_alike += same(alike) ? 1 : 0;
  }
  EXPECT_LT(same_in_corridor, 20);
  EXPECT_GT(same_in_alike, 180) << "but for what is seen of the two other sides";
}

TEST(SceneCatalogue, FittedSceneKeepsOffTheTrajectory) {
  std::vector<Vector3d> positions;
  for (double t = 0.0; t < 20.0; t += 0.05) {
    positions.emplace_back(3.0 + 2.5 * std::cos(0.7 * t), 1.5 * std::sin(0.9 * t) - 4.0,
                           1.0 + 0.5 * std::sin(t));
  }
  for (const FittedStyle style : {FittedStyle::kRoom, FittedStyle::kHall}) {
    const Scene scene = sceneFittedTo(positions, 1, style, 0.6);
    EXPECT_GT(scene.solids().size(), 8U);
    for (const Vector3d& p_w : positions) EXPECT_TRUE(scene.isFree(p_w, 0.599));
  }
}

TEST(SceneCatalogue, RefusesUnknownNamesAndEmptyTrajectories) {
  EXPECT_THROW(makeScene("kitchen", 1), InputError);
  EXPECT_THROW(sceneFittedTo({}, 1, FittedStyle::kRoom), InputError);
}

}  // namespace
}  // namespace vins::simulation
