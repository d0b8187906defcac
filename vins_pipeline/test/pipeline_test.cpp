#include "vins_pipeline/pipeline.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "vins_core/input_error.h"

namespace vins::pipeline {
namespace {

constexpr char kConfig[] = "../config/euroc/euroc_config.yaml";
constexpr Stamp kMs = 1'000'000;
constexpr Stamp kStart = 1'600'000'000'000 * kMs;

PipelineOptions options() { return readPipelineOptions(kConfig, nullptr); }

/// Grey squares in random places, moved to the left from image to image.
cv::Mat imageAt(int index) {
  cv::RNG random(7);
  cv::Mat image(480, 752, CV_8UC1, cv::Scalar(20));
  for (int i = 0; i < 400; ++i) {
    const int x = random.uniform(0, 730) - 2 * index, y = random.uniform(0, 460);
    const cv::Rect square = cv::Rect(x, y, 14, 14) & cv::Rect(0, 0, 752, 480);
    image(square).setTo(random.uniform(60, 250));
  }
  return image;
}

ImuSample sampleAt(Stamp stamp) { return {stamp, {9.81, 0.0, 0.0}, {0.0, 0.0, 0.0}}; }

std::vector<PipelineResult> processAll(Pipeline* pipeline) {
  std::vector<PipelineResult> results;
  while (auto result = pipeline->process()) results.push_back(std::move(*result));
  return results;
}

TEST(Pipeline, AnImageWaitsForItsSamples) {
  Pipeline pipeline(options());
  pipeline.addImage(kStart + 100 * kMs, imageAt(0));
  EXPECT_FALSE(pipeline.process());
  for (int i = 0; i < 20; ++i) pipeline.addImu(sampleAt(kStart + i * 5 * kMs));
  EXPECT_FALSE(pipeline.process());
  pipeline.addImu(sampleAt(kStart + 100 * kMs));
  const auto result = pipeline.process();
  ASSERT_TRUE(result);
  EXPECT_EQ(result->stamp, kStart + 100 * kMs);
  ASSERT_TRUE(result->frame);
  EXPECT_GT(result->frame->observations.size(), 100u);
  EXPECT_EQ(result->estimates.size(), 1u);
  EXPECT_EQ(result->durations.front().first, "tracker");
  EXPECT_FALSE(pipeline.process());
}

TEST(Pipeline, WhatComesOutDoesNotDependOnWhenItCameIn) {
  Pipeline early(options()), late(options());
  std::vector<PipelineResult> first, second;
  const auto collect = [](Pipeline* pipeline, std::vector<PipelineResult>* all) {
    for (PipelineResult& result : processAll(pipeline)) all->push_back(std::move(result));
  };
  // One gets images as soon as they are there, the other all samples first.
  for (int i = 0; i <= 200; ++i) {
    const Stamp now = kStart + i * 5 * kMs;
    if (i % 10 == 0) early.addImage(now, imageAt(i / 10));
    collect(&early, &first);
    early.addImu(sampleAt(now));
    collect(&early, &first);
    late.addImu(sampleAt(now));
  }
  for (int i = 0; i <= 20; ++i) late.addImage(kStart + i * 50 * kMs, imageAt(i));
  collect(&late, &second);
  ASSERT_EQ(first.size(), 21u);
  ASSERT_EQ(second.size(), 21u);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].stamp, second[i].stamp);
    ASSERT_TRUE(first[i].frame && second[i].frame);
    EXPECT_EQ(first[i].frame->observations.size(), second[i].frame->observations.size());
    EXPECT_EQ(first[i].tracker.inliers, second[i].tracker.inliers);
    EXPECT_GT(first[i].tracker.inliers, i == 0 ? -1 : 50) << "the images can be tracked";
    ASSERT_EQ(first[i].estimates.size(), second[i].estimates.size());
  }
}

TEST(Pipeline, AnAccelerometerOnATopicOfItsOwnGivesTheSameOdometry) {
  PipelineOptions parted_options = options();
  parted_options.accel_topic = "/accel";
  Pipeline whole(options()), parted(parted_options);
  std::vector<PipelineResult> first, second;
  for (int i = 0; i <= 600; ++i) {
    const ImuSample sample = sampleAt(kStart + i * 5 * kMs);
    whole.addImu(sample);
    parted.addImu({sample.stamp, {0.0, 0.0, 0.0}, sample.angular_velocity});
    // A third of the rate: the samples between are interpolated.
    if (i % 3 == 0) parted.addAcceleration(sample.stamp, sample.acceleration);
    if (i % 10 != 0) continue;
    whole.addImage(sample.stamp, imageAt(0));
    parted.addImage(sample.stamp, imageAt(0));
    for (PipelineResult& result : processAll(&whole)) first.push_back(std::move(result));
    for (PipelineResult& result : processAll(&parted)) second.push_back(std::move(result));
  }
  ASSERT_EQ(first.size(), second.size());
  std::vector<Pose> poses, parted_poses;
  for (const PipelineResult& result : first) {
    for (const auto& estimate : result.estimates) {
      if (estimate.odometry) poses.push_back(estimate.odometry->state.T_wb);
    }
  }
  for (const PipelineResult& result : second) {
    for (const auto& estimate : result.estimates) {
      if (estimate.odometry) parted_poses.push_back(estimate.odometry->state.T_wb);
    }
  }
  ASSERT_GT(poses.size(), 10u) << "a rig at rest starts";
  ASSERT_EQ(parted_poses.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(parted_poses[i].position, poses[i].position);
    EXPECT_EQ(parted_poses[i].rotation.coeffs(), poses[i].rotation.coeffs());
  }
  EXPECT_TRUE(parted.takeInputEvents().size() == whole.takeInputEvents().size());
}

TEST(Pipeline, ASilentAccelerometerIsTold) {
  PipelineOptions parted_options = options();
  parted_options.accel_topic = "/accel";
  Pipeline pipeline(parted_options);
  for (int i = 0; i <= 220; ++i) pipeline.addImu(sampleAt(kStart + i * 5 * kMs));
  const std::vector<Event> events = pipeline.takeInputEvents();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].code, "imu_accelerometer_missing");
}

TEST(Pipeline, AtTheEndImagesNoLongerWait) {
  Pipeline pipeline(options());
  pipeline.addImage(kStart, imageAt(0));
  EXPECT_FALSE(pipeline.process());
  pipeline.finish();
  const auto result = pipeline.process();
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->estimates.empty()) << "the estimator cannot do without samples";
}

TEST(Pipeline, ARestartedRecordingDoesNotBlock) {
  Pipeline pipeline(options());
  for (int i = 0; i <= 40; ++i) pipeline.addImu(sampleAt(kStart + (60'000 + i * 5) * kMs));
  pipeline.addImage(kStart + 60'190 * kMs, imageAt(0));
  // Would wait for samples that never come.
  pipeline.addImage(kStart + 60'240 * kMs, imageAt(1));
  EXPECT_EQ(processAll(&pipeline).size(), 1u);
  for (int i = 0; i <= 40; ++i) pipeline.addImu(sampleAt(kStart + i * 5 * kMs));
  pipeline.addImage(kStart + 100 * kMs, imageAt(2));
  pipeline.addImage(kStart + 150 * kMs, imageAt(3));
  EXPECT_EQ(processAll(&pipeline).size(), 2u);
}

/// EuRoC's configuration with another way to treat the extrinsic.
PipelineOptions optionsWithExtrinsicMode(const std::string& mode) {
  std::ifstream in(kConfig);
  std::string text(std::istreambuf_iterator<char>(in), {});
  text.replace(text.find("estimate_extrinsic: 0"), 21, "estimate_extrinsic: " + mode);
  const std::string path = ::testing::TempDir() + "pipeline_test_extrinsic.yaml";
  std::ofstream(path) << text;
  const PipelineOptions options = readPipelineOptions(path, nullptr);
  std::filesystem::remove(path);
  return options;
}

TEST(Pipeline, TheTrackerDoesWithoutTheGyroscopeWhereTheExtrinsicIsUnknown) {
  for (const std::string mode : {"0", "1", "2"}) {
    Pipeline pipeline(optionsWithExtrinsicMode(mode));
    for (int i = 0; i <= 20; ++i) pipeline.addImu(sampleAt(kStart + i * 5 * kMs));
    pipeline.addImage(kStart, imageAt(0));
    pipeline.addImage(kStart + 50 * kMs, imageAt(1));
    const std::vector<PipelineResult> results = processAll(&pipeline);
    ASSERT_EQ(results.size(), 2u);
    // The file has a matrix in any case.
    EXPECT_EQ(results[1].tracker.turn_measured, mode != "2") << mode;
  }
}

TEST(PipelineOptions, ReadsAKalibrChainAsItIs) {
  const std::string path = ::testing::TempDir() + "pipeline_test_chain.yaml";
  std::ofstream(path)
      << "cam0:\n  T_cam_imu:\n  - [0.0, 1.0, 0.0, 0.1]\n  - [-1.0, 0.0, 0.0, 0.2]\n"
         "  - [0.0, 0.0, 1.0, 0.3]\n  - [0.0, 0.0, 0.0, 1.0]\n"
         "  camera_model: pinhole\n  distortion_model: equidistant\n"
         "  distortion_coeffs: [0.01, 0.0, 0.0, 0.0]\n"
         "  intrinsics: [300.0, 300.0, 320.0, 240.0]\n  resolution: [640, 480]\n"
         "  rostopic: my/image\n  timeshift_cam_imu: 0.004\n"
         "imu0:\n  accelerometer_noise_density: 0.02\n"
         "  accelerometer_random_walk: 0.001\n  gyroscope_noise_density: 0.0003\n"
         "  gyroscope_random_walk: 0.00004\n  rostopic: /my/imu\n";
  std::vector<std::string> warnings;
  const PipelineOptions read = readPipelineOptions(path, &warnings);
  std::filesystem::remove(path);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("'my/image' is looked for as '/my/image'"), std::string::npos);
  EXPECT_EQ(read.imu_topic, "/my/imu");
  EXPECT_EQ(read.image_topics, std::vector<std::string>{"/my/image"}) << "absolute, as in bags";
  EXPECT_EQ(read.cameras.at(0)->model(), camera_model::CameraModel::kKannalaBrandt);
  EXPECT_EQ(read.estimator.td, 0.004);
  EXPECT_EQ(read.estimator.imu.gyroscope_walk, 0.00004);
  EXPECT_TRUE((read.estimator.T_bc * Eigen::Vector3d(0.1, 0.2, 0.3)).isZero(1e-12));
  EXPECT_TRUE(read.tracker.uses_gyroscope);
}

TEST(PipelineOptions, TheConfigurationOfEurocIsKnownKeyByKey) {
  std::vector<std::string> warnings;
  const PipelineOptions read = readPipelineOptions(kConfig, &warnings);
  for (const std::string& warning : warnings) ADD_FAILURE() << warning;
  EXPECT_EQ(read.imu_topic, "/imu0");
  EXPECT_EQ(read.image_topics, std::vector<std::string>{"/cam0/image_raw"});
  EXPECT_EQ(read.cameras.at(0)->imageSize(), (camera_model::ImageSize{752, 480}));
  EXPECT_EQ(read.estimator.imu.accelerometer_noise, 2.0e-3);
  EXPECT_EQ(read.tracker.frequency, 0.0);
  EXPECT_TRUE(read.mask.empty());
}

TEST(PipelineOptions, UnknownKeysAndMissingFilesAreNamed) {
  const std::string path = ::testing::TempDir() + "pipeline_test.yaml";
  std::ifstream in(kConfig);
  std::ofstream(path) << std::string(std::istreambuf_iterator<char>(in), {}) << "max_cn: 3\n";
  std::vector<std::string> warnings;
  readPipelineOptions(path, &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("'max_cn' is ignored; did you mean 'max_cnt'"), std::string::npos);
  std::filesystem::remove(path);
  EXPECT_THROW(readPipelineOptions(path, nullptr), InputError);
}

}  // namespace
}  // namespace vins::pipeline
