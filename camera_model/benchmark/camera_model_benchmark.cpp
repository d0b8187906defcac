// Cost of projecting and unprojecting a point, for each camera model.

#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "camera_model/testing/example_cameras.h"

namespace {

std::vector<Eigen::Vector2d> gridOf(const vins::camera_model::Camera& camera) {
  std::vector<Eigen::Vector2d> pixels;
  for (int v = 5; v < camera.imageSize().height; v += 23) {
    for (int u = 5; u < camera.imageSize().width; u += 23) {
      if (camera.unproject(Eigen::Vector2d(u, v))) pixels.emplace_back(u + 0.3, v + 0.6);
    }
  }
  return pixels;
}

void unprojectPoint(benchmark::State& state) {
  const auto camera =
      vins::camera_model::testing::exampleCameras()[static_cast<std::size_t>(state.range(0))];
  const auto pixels = gridOf(*camera);
  state.SetLabel(toString(camera->model()));
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(camera->unproject(pixels[i]));
    if (++i == pixels.size()) i = 0;
  }
}

void projectPoint(benchmark::State& state) {
  const auto camera =
      vins::camera_model::testing::exampleCameras()[static_cast<std::size_t>(state.range(0))];
  const bool with_jacobians = state.range(1) != 0;
  std::vector<Eigen::Vector3d> points;
  for (const auto& pixel : gridOf(*camera)) points.push_back(3.0 * *camera->unproject(pixel));
  state.SetLabel(std::string(toString(camera->model())) +
                 (with_jacobians ? " with Jacobians" : ""));
  std::size_t i = 0;
  vins::camera_model::ProjectionJacobians jacobians;
  for (auto _ : state) {
    benchmark::DoNotOptimize(camera->project(points[i], with_jacobians ? &jacobians : nullptr));
    if (++i == points.size()) i = 0;
  }
}

}  // namespace

BENCHMARK(unprojectPoint)->DenseRange(0, 3);
BENCHMARK(projectPoint)->ArgsProduct({{0, 1, 2, 3}, {0, 1}});
BENCHMARK_MAIN();
