#include "simulation/household_scene.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "camera_model/pinhole_radtan.h"
#include "simulation/household_recording.h"
#include "simulation/image_simulator.h"
#include "simulation/image_statistics.h"
#include "simulation/scene_catalogue.h"

namespace vins::simulation {
namespace {

using Eigen::Vector3d;

/// A pinhole of 320 x 240 px that looks along z.
std::shared_ptr<const camera_model::Camera> smallCamera() {
  camera_model::CameraParameters p(9);
  p << 200.0, 200.0, 160.0, 120.0, 0.0, 0.0, 0.0, 0.0, 0.0;
  return std::make_shared<camera_model::PinholeRadtan>("cam0", camera_model::ImageSize{320, 240},
                                                       p);
}

/// A dark mirror-like panel 2 m ahead, and a lamp to the right of the camera.
std::shared_ptr<const Scene> glossyPanel(const Vector3d& lamp_w) {
  Panel panel;
  panel.centre = {0.0, 0.0, 2.0};
  panel.axis_s = -Vector3d::UnitX();
  panel.axis_t = Vector3d::UnitY();
  panel.half_s = panel.half_t = 3.0;
  panel.texture = std::make_shared<const Texture>(cv::Mat(4, 4, CV_32FC1, cv::Scalar(0.1)));
  panel.gloss = {0.8, 0.1, lamp_w};
  return std::make_shared<const Scene>(
      std::vector<Panel>{panel}, std::vector<Solid>{}, std::vector<MovingObject>{},
      Eigen::AlignedBox3d(Vector3d(-9, -9, -9), Vector3d(9, 9, 9)));
}

cv::Point brightest(const ImageSimulator& camera, const Vector3d& p_wc) {
  const Pose T_wb(Eigen::Quaterniond::Identity(), p_wc);
  const cv::Mat image = camera.render([&](double) { return T_wb; }, 0.0, 0);
  cv::Point place;
  cv::minMaxLoc(image, nullptr, nullptr, nullptr, &place);
  return place;
}

TEST(Gloss, TheLampIsSeenWhereAMirrorShowsIt) {
  ImageOptions options;
  options.full_well_electrons = 0.0;
  options.read_noise_dn = 0.0;
  options.vignetting = 0.0;
  const Vector3d lamp(1.0, -0.4, 0.5);
  const ImageSimulator camera(glossyPanel(lamp), smallCamera(), Pose(), options, 1, "cam0");
  for (const Vector3d& p_wc : {Vector3d(0, 0, 0), Vector3d(0.3, 0.1, 0.4), Vector3d(-0.4, 0, -1)}) {
    const Vector3d image_of_lamp(lamp.x(), lamp.y(), 4.0 - lamp.z());
    const Vector3d ray = image_of_lamp - p_wc;
    const cv::Point found = brightest(camera, p_wc);
    // The maximum is flat: 8 bits know it to some pixels.
    EXPECT_NEAR(found.x, 160.0 + 200.0 * ray.x() / ray.z(), 3.0);
    EXPECT_NEAR(found.y, 120.0 + 200.0 * ray.y() / ray.z(), 3.0);
  }
}

TEST(Gloss, ALampBehindThePanelIsNotMirrored) {
  ImageOptions options;
  const ImageSimulator camera(glossyPanel({0.0, 0.0, 3.0}), smallCamera(), Pose(), options, 1,
                              "cam0");
  const cv::Mat image = camera.render([](double) { return Pose(); }, 0.0, 0);
  double most = 0.0;
  cv::minMaxLoc(image, nullptr, &most);
  EXPECT_LT(most, 40.0);
}

/// Of a real handheld walk through a bedroom with a consumer's camera: 113 images of 53 s, 640 x
/// 360, measured by measure_images.
struct RealWalk {
  static constexpr double kMeanGrey = 88.0, kNoise = 0.34, kSharpness = 1.56;
  static constexpr double kCornersOf2 = 110.0, kCornersOf4 = 69.0, kCornersOf8 = 37.5;
  static constexpr double kGradientAbove8 = 0.120, kGradientBelow2 = 0.619;
};

/// Statistics over images of the preset's walks of several seeds.
ImageStatistics householdStatistics() {
  ImageStatisticsMeter meter;
  for (const std::uint64_t seed : {1, 3, 5, 6}) {
    const SimulatedRecording recording = simulateRecording(householdRecording(seed, 30.0));
    const std::size_t count = recording.image_stamps.size();
    for (std::size_t i = 0; i < 10; ++i) meter.add(recording.render(0, i * count / 10));
  }
  return meter.result();
}

TEST(HouseholdImages, AreAsHardAsThoseOfARealWalk) {
  const ImageStatistics walk = householdStatistics();
  // Not easier: at most a tenth more corners of any strength. Nor a room without anything to see.
  const auto expectLikeReal = [](double value, double real) {
    EXPECT_LT(value, 1.1 * real);
    EXPECT_GT(value, 0.3 * real);
  };
  expectLikeReal(walk.corners[1], RealWalk::kCornersOf2);
  expectLikeReal(walk.corners[2], RealWalk::kCornersOf4);
  expectLikeReal(walk.corners[3], RealWalk::kCornersOf8);
  expectLikeReal(walk.gradient_histogram[3] + walk.gradient_histogram[4],
                 RealWalk::kGradientAbove8);
  EXPECT_NEAR(walk.gradient_histogram[0] + walk.gradient_histogram[1], RealWalk::kGradientBelow2,
              0.25);
  EXPECT_NEAR(walk.mean_grey, RealWalk::kMeanGrey, 25.0);
  EXPECT_GT(walk.noise, 0.5 * RealWalk::kNoise);
  EXPECT_LT(walk.noise, 2.5 * RealWalk::kNoise);
  // As blurred, or more.
  EXPECT_LT(walk.sharpness, 1.1 * RealWalk::kSharpness);
  EXPECT_GT(walk.sharpness, 0.6 * RealWalk::kSharpness);
}

TEST(HouseholdImages, ARichRoomIsNotAsHard) {
  RecordingOptions options;
  options.trajectory = "fast";
  options.scene = "room";
  options.duration = 10.0;
  const SimulatedRecording recording = simulateRecording(options);
  ImageStatisticsMeter meter;
  for (std::size_t i = 20; i < 180; i += 40) meter.add(recording.render(0, i));
  EXPECT_GT(meter.result().corners[2], 1.5 * RealWalk::kCornersOf4);
}

TEST(HouseholdScene, HasAWindowThatIsBlownOutByDayAndDarkPlaces) {
  int blown_out = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    double brightest = 0.0, darkest = 1.0;
    const Scene scene = makeHousehold(seed);
    for (const Panel& panel : scene.panels()) {
      const double luminance = panel.luminanceAt(0.0, 0.0);
      if (panel.half_s * panel.half_t > 0.2) brightest = std::max(brightest, luminance);
      darkest = std::min(darkest, luminance);
    }
    blown_out += brightest > 2.0 ? 1 : 0;
    EXPECT_LT(darkest, 0.05) << seed;
  }
  EXPECT_GE(blown_out, 3);
  EXPECT_LE(blown_out, 9);
}

}  // namespace
}  // namespace vins::simulation
