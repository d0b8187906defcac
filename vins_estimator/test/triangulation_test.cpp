#include "vins_estimator/visual/triangulation.h"

#include <gtest/gtest.h>

#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;

std::vector<TriangulationView> viewsOf(const Vector3d& point, const std::vector<Pose>& cameras) {
  std::vector<TriangulationView> views;
  for (const Pose& T_wc : cameras) {
    views.push_back({T_wc, (T_wc.inverse() * point).normalized(), 460.0});
  }
  return views;
}

std::vector<Pose> sidewaysCameras() {
  return {Pose(so3::exp({0.02, -0.1, 0.05}), {0.0, 0.1, 0.0}),
          Pose(so3::exp({-0.05, 0.03, 0.0}), {0.3, 0.0, 0.05}),
          Pose(so3::exp({0.0, 0.1, -0.2}), {0.6, -0.1, 0.0})};
}

TEST(Triangulation, RecoversPointWithoutNoise) {
  for (const Vector3d& point : {Vector3d(0.5, 0.2, 1.0), Vector3d(-1.0, 2.0, 8.0)}) {
    const auto views = viewsOf(point, sidewaysCameras());
    const Triangulation result = triangulate(views);
    ASSERT_TRUE(result.ok()) << toString(result.status);
    // Digits are lost by the parallax, a tenth of a radian or less.
    EXPECT_LT((result.position_w - point).norm(), 1e-9);
    EXPECT_NEAR(result.distance, (point - views[0].T_wc.position).norm(), 1e-9);
    EXPECT_LT(result.rms, 1e-6);
  }
}

TEST(Triangulation, LandmarkParametersGiveThePointBack) {
  auto views = viewsOf({0.4, -0.3, 5.0}, sidewaysCameras());
  views[0].bearing = (views[0].bearing + Vector3d(1e-3, -2e-3, 0.0)).normalized();
  const Triangulation result = triangulate(views);
  ASSERT_TRUE(result.ok());
  const LandmarkAnchor anchor{views[0].bearing, tangentBasis(views[0].bearing)};
  const Vector3d in_host = anchoredDirection(anchor, result.landmark) / result.landmark.z();
  EXPECT_LT((views[0].T_wc * in_host - result.position_w).norm(), 1e-9);
  // The host's own bearing is a measurement as the others, and gives way to them.
  EXPECT_GT(result.landmark.head<2>().norm(), 1e-4);
}

TEST(Triangulation, IsTheLeastSquaresSolution) {
  auto views = viewsOf({0.4, -0.3, 5.0}, sidewaysCameras());
  views[1].bearing = (views[1].bearing + Vector3d(1e-3, 1e-3, 0.0)).normalized();
  const Triangulation best = triangulate(views);
  ASSERT_TRUE(best.ok());
  const auto cost = [&](const Vector3d& point) {
    double sum = 0.0;
    for (const auto& view : views) {
      const Vector3d unit = (view.T_wc.inverse() * point).normalized();
      sum += unit.cross(view.bearing).squaredNorm();
    }
    return sum;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-1e-3, 1e-3}) {
      EXPECT_GT(cost(best.position_w + step * Vector3d::Unit(axis)), cost(best.position_w));
    }
  }
}

TEST(Triangulation, DoesNotDependOnTheWorld) {
  const Vector3d point(0.4, -0.3, 5.0);
  const Pose T_nw(so3::exp({0.3, -1.0, 2.0}), {1e4, -2e4, 3e3});
  auto cameras = sidewaysCameras();
  const Triangulation here = triangulate(viewsOf(point, cameras));
  for (Pose& camera : cameras) camera = T_nw * camera;
  const Triangulation there = triangulate(viewsOf(T_nw * point, cameras));
  ASSERT_TRUE(here.ok() && there.ok());
  // At 20 km a double has 4e-12 m, which the parallax magnifies.
  EXPECT_LT((here.landmark - there.landmark).norm(), 1e-8);
}

TEST(Triangulation, SaysHowUncertainTheDistanceIs) {
  const auto sigma = [](double distance) {
    return triangulate(viewsOf({0.0, 0.0, distance}, sidewaysCameras())).sigma_inverse_distance;
  };
  // In inverse distance nearly the same at all distances.
  EXPECT_NEAR(sigma(20.0) / sigma(10.0), 1.0, 0.05);
}

TEST(Triangulation, RefusesWhatItCannotTell) {
  const Vector3d point(0.4, -0.3, 5.0);
  EXPECT_EQ(triangulate(viewsOf(point, {Pose()})).status, TriangulationStatus::kTooFewViews);
  EXPECT_EQ(triangulate(viewsOf(point, {Pose(), Pose(so3::exp({0, 0.1, 0}), {0, 0, 0})})).status,
            TriangulationStatus::kLittleParallax);
  auto views = viewsOf(point, sidewaysCameras());
  for (auto& view : views) view.bearing = -view.bearing;
  EXPECT_EQ(triangulate(views).status, TriangulationStatus::kBehindCamera);
  TriangulationOptions near;
  near.max_distance = 2.0;
  EXPECT_EQ(triangulate(viewsOf(point, sidewaysCameras()), near).status,
            TriangulationStatus::kBadDistance);
  views = viewsOf(point, sidewaysCameras());
  views[2].bearing = (views[2].bearing + Vector3d(0.0, 0.05, 0.0)).normalized();
  EXPECT_EQ(triangulate(views).status, TriangulationStatus::kBadResidual);
}

TEST(Triangulation, ChecksOptions) {
  TriangulationOptions options;
  options.max_rms = -1.0;
  EXPECT_THROW(options.validate(), InputError);
}

}  // namespace
}  // namespace vins::estimator
