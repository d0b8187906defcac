#pragma once

#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "camera_model/testing/example_cameras.h"
#include "plane_world.h"
#include "vins_core/imu.h"
#include "vins_core/pose.h"
#include "vins_core/so3.h"
#include "vins_core/testing/shared_data.h"

namespace vins::feature_tracker::testing {

/// Images of one camera with the gyroscope's samples, for measuring.
class ImageSequence {
 public:
  virtual ~ImageSequence() = default;
  virtual std::string name() const = 0;
  virtual std::size_t size() const = 0;
  virtual Stamp stamp(std::size_t i) const = 0;
  virtual cv::Mat image(std::size_t i) const = 0;
  virtual std::vector<ImuSample> imu(Stamp after, Stamp up_to) const = 0;
  virtual Pose bodyToCamera() const = 0;

  std::shared_ptr<const camera_model::Camera> camera() const {
    return vins::camera_model::testing::exampleCameras().front();
  }
};

/// EuRoC's cam0 and imu0 in the ASL layout.
class EurocSequence : public ImageSequence {
 public:
  explicit EurocSequence(std::string folder) : folder_(std::move(folder)) {
    std::string line;
    for (std::ifstream in(folder_ + "/mav0/cam0/data.csv"); std::getline(in, line);) {
      if (!line.empty() && line[0] != '#') stamps_.push_back(std::stoll(line));
    }
    for (std::ifstream in(folder_ + "/mav0/imu0/data.csv"); std::getline(in, line);) {
      if (line.empty() || line[0] == '#') continue;
      ImuSample sample;
      char* next = nullptr;
      sample.stamp = std::strtoll(line.c_str(), &next, 10);
      for (int k = 0; k < 3; ++k) sample.angular_velocity[k] = std::strtod(next + 1, &next);
      for (int k = 0; k < 3; ++k) sample.acceleration[k] = std::strtod(next + 1, &next);
      imu_.push_back(sample);
    }
  }

  std::string name() const override { return folder_; }
  std::size_t size() const override { return stamps_.size(); }
  Stamp stamp(std::size_t i) const override { return stamps_[i]; }
  cv::Mat image(std::size_t i) const override {
    return cv::imread(folder_ + "/mav0/cam0/data/" + std::to_string(stamps_[i]) + ".png",
                      cv::IMREAD_GRAYSCALE);
  }
  std::vector<ImuSample> imu(Stamp after, Stamp up_to) const override {
    std::vector<ImuSample> samples;
    for (const ImuSample& sample : imu_) {
      if (sample.stamp > after && sample.stamp <= up_to) samples.push_back(sample);
    }
    return samples;
  }
  Pose bodyToCamera() const override {
    Eigen::Matrix4d T_bc;
    T_bc << 0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,  //
        0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,          //
        -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,      //
        0.0, 0.0, 0.0, 1.0;
    return poseFromMatrix(T_bc);
  }

 private:
  std::string folder_;
  std::vector<Stamp> stamps_;
  std::vector<ImuSample> imu_;
};

/// A camera that sways in front of a textured plane, where there is no recording.
class PlaneSequence : public ImageSequence {
 public:
  PlaneSequence() : world_(camera()) {}

  std::string name() const override { return "generated plane"; }
  std::size_t size() const override { return 200; }
  Stamp stamp(std::size_t i) const override { return 1'000'000'000 + 50'000'000 * Stamp(i); }
  cv::Mat image(std::size_t i) const override { return world_.render(poseAt(stamp(i))); }
  std::vector<ImuSample> imu(Stamp after, Stamp up_to) const override {
    constexpr Stamp kPeriod = 5'000'000;
    std::vector<ImuSample> samples;
    for (Stamp t = after - after % kPeriod + kPeriod; t <= up_to; t += kPeriod) {
      const Eigen::Quaterniond turn =
          poseAt(t - kPeriod / 2).rotation.conjugate() * poseAt(t + kPeriod / 2).rotation;
      samples.push_back({t, Eigen::Vector3d::Zero(), so3::log(turn) / toSeconds(kPeriod)});
    }
    return samples;
  }
  Pose bodyToCamera() const override { return {}; }

 private:
  static Pose poseAt(Stamp stamp) {
    const double t = toSeconds(stamp);
    const Eigen::Vector3d turn(0.2 * std::sin(1.1 * t), 0.25 * std::sin(0.8 * t),
                               0.3 * std::sin(0.7 * t));
    return {so3::exp(turn), Eigen::Vector3d(2.0 * std::sin(0.4 * t), std::cos(0.5 * t), 0.0)};
  }

  PlaneWorld world_;
};

/// The real recording where it is there.
inline std::unique_ptr<ImageSequence> measuredSequence() {
  const std::string folder = vins::testing::sharedData("euroc_mh01_flight");
  if (std::ifstream(folder + "/mav0/cam0/data.csv").good()) {
    return std::make_unique<EurocSequence>(folder);
  }
  return std::make_unique<PlaneSequence>();
}

}  // namespace vins::feature_tracker::testing
