// What place recognition costs a keyframe: describing its image, asking a database of 2,000
// keyframes, and verifying a loop. On random descriptors about some hundred thousand themes, so
// that words are shared as in images; pictures are of random rectangles.

#include <random>

#include <benchmark/benchmark.h>
#include <opencv2/core/utility.hpp>

#include "camera_model/testing/example_cameras.h"
#include "loop_scene.h"
#include "pose_graph/loop/loop_detector.h"
#include "pose_graph/loop/loop_verifier.h"
#include "pose_graph/place/keyframe_view.h"
#include "pose_graph/place/vocabulary_training.h"
#include "random_descriptors.h"
#include "textured_image.h"

namespace {

using vins::pose_graph::testing::texturedImage;

constexpr int kKeyframes = 2000;
constexpr std::size_t kFeatures = 650;

/// Descriptors of keyframe `index`: half of them those of keyframes nearby, half everybody's.
std::vector<vins::pose_graph::BriefDescriptor> descriptorsOf(
    int index, const std::vector<vins::pose_graph::BriefDescriptor>& themes) {
  std::mt19937_64 random(static_cast<std::uint64_t>(index));
  std::vector<vins::pose_graph::BriefDescriptor> descriptors;
  for (std::size_t i = 0; i < kFeatures; ++i) {
    const std::size_t theme = i % 2 == 0
                                  ? random() % 1000
                                  : 1000 + (40 * static_cast<std::size_t>(index) + random() % 400) %
                                               (themes.size() - 1000);
    descriptors.push_back(vins::pose_graph::testing::withNoise(themes[theme], 15, &random));
  }
  return descriptors;
}

/// A vocabulary of ten thousand words, and the themes it was trained on.
struct World {
  std::vector<vins::pose_graph::BriefDescriptor> themes =
      vins::pose_graph::testing::randomDescriptors(20000, 1);
  vins::pose_graph::Vocabulary vocabulary = train();

  vins::pose_graph::Vocabulary train() const {
    std::vector<std::vector<vins::pose_graph::BriefDescriptor>> images;
    for (int i = 0; i < 300; ++i) images.push_back(descriptorsOf(7 * i, themes));
    vins::pose_graph::VocabularyTrainingOptions options;
    options.levels = 4;
    options.iterations = 3;
    return vins::pose_graph::trainVocabulary(images, options);
  }
};

const World& world() {
  static const World one;
  return one;
}

void describeKeyframe(benchmark::State& state) {
  const auto camera = vins::camera_model::testing::exampleCameras().front();
  const vins::pose_graph::ViewDescriber describer(
      *camera, world().vocabulary, vins::pose_graph::BriefPattern::generate(1, 49), {});
  const cv::Mat1b image = texturedImage(752, 480, 1);
  vins::Keyframe keyframe;
  for (int i = 0; i < 150; ++i) {
    vins::KeyframePoint point;
    point.pixel = {30.0 + 46.0 * (i % 15), 30.0 + 42.0 * (i / 15)};
    keyframe.points.push_back(point);
  }
  for (auto _ : state) benchmark::DoNotOptimize(describer.describe(keyframe, image));
}

void queryDatabase(benchmark::State& state) {
  vins::pose_graph::LoopDetector detector(world().vocabulary.wordCount(), {});
  for (int i = 0; i < kKeyframes; ++i) {
    detector.add(i, world().vocabulary.describe(descriptorsOf(i, world().themes), 0).bag);
  }
  std::int64_t id = kKeyframes;
  for (auto _ : state) {
    state.PauseTiming();
    const auto bag =
        world().vocabulary.describe(descriptorsOf(static_cast<int>(id % 1500), world().themes), 0);
    state.ResumeTiming();
    benchmark::DoNotOptimize(detector.detect(id, id * 250'000'000, bag.bag));
    state.PauseTiming();
    detector.remove(id++);
    state.ResumeTiming();
  }
}

void verifyLoop(benchmark::State& state) {
  vins::pose_graph::testing::LoopScene scene;
  scene.good = 60;
  scene.wrong = static_cast<int>(state.range(0));
  const auto views = scene.views();
  const vins::pose_graph::LoopVerifier verifier({});
  for (auto _ : state) benchmark::DoNotOptimize(verifier.verify(views.query, views.old));
}

BENCHMARK(describeKeyframe)->Unit(benchmark::kMillisecond);
BENCHMARK(queryDatabase)->Unit(benchmark::kMillisecond)->Iterations(200);
BENCHMARK(verifyLoop)->Arg(0)->Arg(40)->Arg(90)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
