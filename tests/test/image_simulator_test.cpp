#include "simulation/image_simulator.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "camera_model/pinhole_radtan.h"
#include "simulated_views.h"
#include "simulation/scene_catalogue.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using vins::camera_model::testing::parametersOf;

double difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

std::shared_ptr<const Texture> plain(double luminance) {
  return std::make_shared<const Texture>(cv::Mat(4, 4, CV_32FC1, cv::Scalar(luminance)));
}

/// The room with each panel of one grey of its own, and none of its neighbours'.
Scene greyRoom() {
  const Scene room = *sharedRoom();
  std::vector<Panel> panels = room.panels();
  for (std::size_t i = 0; i < panels.size(); ++i) {
    panels[i].texture = plain((20.0 + static_cast<double>(37 * i % 211)) / 255.0);
    panels[i].light = 1.0;
    panels[i].light_s = panels[i].light_t = 0.0;
  }
  return Scene(panels, room.solids(), {}, room.interior());
}

/// A wall 2 m ahead, dark on the left of x = 0 of a camera at the origin and bright on the right.
Scene edgeAhead() {
  std::vector<Panel> panels(2);
  for (int i = 0; i < 2; ++i) {
    panels[i].centre = {2.0, i == 0 ? 5.0 : -5.0, 0.0};
    panels[i].axis_s = -Vector3d::UnitY();
    panels[i].axis_t = Vector3d::UnitZ();
    panels[i].half_s = panels[i].half_t = 5.0;
    panels[i].texture = plain(i == 0 ? 0.2 : 0.8);
  }
  return Scene(panels, {}, {}, AlignedBox3d(Vector3d(-1, -1, -1), Vector3d(1, 1, 1)));
}

std::shared_ptr<const camera_model::Camera> idealPinhole() {
  return std::make_shared<camera_model::PinholeRadtan>(
      "ideal", camera_model::ImageSize{320, 240},
      parametersOf({400, 400, 159.5, 119.5, 0, 0, 0, 0, 0}));
}

struct EdgeProfile {
  double position;  ///< [px]
  double variance;  ///< of its derivative [px^2]
};

/// The edge in one row of an image of edgeAhead().
EdgeProfile profileOf(const cv::Mat& image, int row) {
  double weight = 0.0, first = 0.0, second = 0.0;
  for (int x = 0; x + 1 < image.cols; ++x) {
    const double step = image.at<std::uint8_t>(row, x + 1) - image.at<std::uint8_t>(row, x);
    const double place = x + 0.5;
    weight += step, first += step * place, second += step * place * place;
  }
  const double position = first / weight;
  return {position, second / weight - position * position};
}

TEST(ImageSimulator, GreyValuesAreThoseOfThePanelsThatRaysMeet) {
  const auto scene = std::make_shared<const Scene>(greyRoom());
  for (const auto& camera : vins::camera_model::testing::exampleCameras()) {
    ImageOptions options = noiseFree();
    options.exposure_s = 0.0;
    const ImageSimulator simulator(scene, camera, forwardCamera(), options, 1, "cam0");
    const Pose T_wb = roomTrajectory(1.3);
    const cv::Mat image = simulator.render(roomTrajectory, 1.3, 0);
    const Pose T_wc = T_wb * forwardCamera();
    int compared = 0;
    for (int v = 7; v < image.rows; v += 11) {
      for (int u = 5; u < image.cols; u += 11) {
        // Away from edges all rays of the lens blur's reach meet the same panel.
        int panel = -2;
        double luminance = 0.0;
        for (const auto& [du, dv] : {std::pair{-3, -3}, {3, -3}, {-3, 3}, {3, 3}, {0, 0}}) {
          const auto bearing = camera->unproject(Vector2d(u + du, v + dv));
          const auto hit =
              bearing ? scene->intersect(T_wc.position, T_wc.rotation * *bearing) : std::nullopt;
          const int met = hit ? hit->panel : -1;
          panel = panel == -2 || panel == met ? met : -3;
          luminance = hit ? hit->luminance : 0.0;
        }
        if (panel < 0) continue;
        ++compared;
        EXPECT_NEAR(image.at<std::uint8_t>(v, u), 255.0 * luminance, 1.01)
            << camera->name() << " " << u << " " << v;
      }
    }
    EXPECT_GT(compared, 500) << camera->name();
  }
}

TEST(ImageSimulator, SameSeedGivesTheSameBytesAndAnotherDoesNot) {
  const auto camera = vins::camera_model::testing::exampleCameras().front();
  ImageOptions options;
  options.rolling_shutter_readout_s = 0.01;
  const ImageSimulator a(sharedRoom(), camera, forwardCamera(), options, 5, "cam0");
  const ImageSimulator b(sharedRoom(), camera, forwardCamera(), options, 6, "cam0");
  options.threads = 3;
  const ImageSimulator c(sharedRoom(), camera, forwardCamera(), options, 5, "cam0");
  const cv::Mat image = a.render(roomTrajectory, 2.0, 17);
  EXPECT_EQ(difference(image, a.render(roomTrajectory, 2.0, 17)), 0.0);
  EXPECT_EQ(difference(image, c.render(roomTrajectory, 2.0, 17)), 0.0) << "threads";
  EXPECT_GT(difference(image, b.render(roomTrajectory, 2.0, 17)), 0.0) << "seed";
  EXPECT_GT(difference(image, a.render(roomTrajectory, 2.0, 18)), 0.0) << "frame";
}

TEST(ImageSimulator, EdgeLiesWhereItProjects) {
  const auto scene = std::make_shared<const Scene>(edgeAhead());
  ImageOptions options = noiseFree();
  options.exposure_s = 0.0;
  const ImageSimulator simulator(scene, idealPinhole(), centredCamera(), options, 1, "cam0");
  for (double y = -0.02; y < 0.02; y += 0.0013) {
    const Pose T_wb(Eigen::Quaterniond::Identity(), {0.0, y, 0.0});
    const cv::Mat image = simulator.render([&](double) { return T_wb; }, 0.0, 0);
    const double expected = simulator.project(T_wb, {2.0, 0.0, 0.0})->x();
    // 16 rays across the pixel, 8 bits.
    EXPECT_NEAR(profileOf(image, 120).position, expected, 0.04);
  }
}

/// Mean profile of an edge that moves by so many pixels during the exposure, over all phases of the
/// pixel grid; its position relative to where it projects in the middle of the exposure.
EdgeProfile blurredProfile(double motion_px) {
  const auto scene = std::make_shared<const Scene>(edgeAhead());
  ImageOptions options = noiseFree();
  options.exposure_s = 0.01;
  const ImageSimulator simulator(scene, idealPinhole(), centredCamera(), options, 1, "cam0");
  const int phases = 17;  // no multiple of the number of rays
  EdgeProfile mean{0.0, 0.0};
  for (int phase = 0; phase < phases; ++phase) {
    // 400 px focal length at 2 m: 200 px per metre.
    const auto moving = [&](double t_s) {
      const double pixels = motion_px * (t_s - 4.0) / 0.01 + (phase + 0.5) / phases;
      return Pose(Eigen::Quaterniond::Identity(), {0.0, pixels / 200.0, 0.0});
    };
    const EdgeProfile profile = profileOf(simulator.render(moving, 4.0, 0), 120);
    const double expected = simulator.project(moving(4.0), {2.0, 0.0, 0.0})->x();
    // Eight rays at each instant of a blurred edge are 1 / 16 px at worst, 8 bits a little more.
    EXPECT_NEAR(profile.position, expected, 0.07) << "motion " << motion_px;
    mean.position += (profile.position - expected) / phases;
    mean.variance += profile.variance / phases;
  }
  return mean;
}

TEST(ImageSimulator, ExposureBlursAnEdgeByItsMotion) {
  const EdgeProfile sharp = blurredProfile(0.0);
  for (const double motion_px : {2.0, 3.3, 5.0, 12.0}) {
    const EdgeProfile blurred = blurredProfile(motion_px);
    // A box of that width.
    const double width = std::sqrt(12.0 * (blurred.variance - sharp.variance));
    EXPECT_NEAR(width, motion_px, 0.05 * motion_px);
    EXPECT_NEAR(blurred.position, 0.0, 0.01) << "the stamp is the exposure's middle";
  }
}

TEST(ImageSimulator, RollingShutterReadsLaterRowsLater) {
  const auto scene = std::make_shared<const Scene>(edgeAhead());
  ImageOptions options = noiseFree();
  options.exposure_s = 0.0;
  options.rolling_shutter_readout_s = 0.024;
  const ImageSimulator simulator(scene, idealPinhole(), centredCamera(), options, 1, "cam0");
  EXPECT_DOUBLE_EQ(simulator.timeOfRow(1.0, 120.0), 1.012);
  const auto moving = [](double t_s) {
    return Pose(Eigen::Quaterniond::Identity(), {0.0, 5.0 * (t_s - 1.0), 0.0});
  };
  const cv::Mat image = simulator.render(moving, 1.0, 0);
  for (int row = 10; row < 230; row += 20) {
    // Moving to the left by 5 m/s at 200 px/m: the edge goes to the right by 1 px per ms.
    EXPECT_NEAR(profileOf(image, row).position, 159.5 + 1000.0 * 0.024 * row / 240.0, 0.05);
  }
}

TEST(ImageSimulator, MovingObjectChangesOnlyWhatItCovers) {
  const auto still = std::make_shared<const Scene>(greyRoom());
  const Vector3d half(0.3, 0.3, 0.3), middle(2.0, 0.0, 1.5);
  const auto moving = std::make_shared<const Scene>(
      still->with(makeSwingingBlock(middle, {0.0, 0.5, 0.0}, 2.0, half, 1)));
  const auto camera = idealPinhole();
  const ImageSimulator without(still, camera, centredCamera(), noiseFree(), 1, "cam0");
  const ImageSimulator with(moving, camera, centredCamera(), noiseFree(), 1, "cam0");
  const auto stand = [](double) { return Pose(Eigen::Quaterniond::Identity(), {0, 0, 1.5}); };
  for (const double t_s : {0.0, 0.25, 0.5}) {
    const cv::Mat a = without.render(stand, t_s, 0), b = with.render(stand, t_s, 0);
    const double y = 0.5 * std::sin(M_PI * t_s);
    const auto column = [&](double x, double side) {
      return with.project(stand(0), {x, y + side, 1.5})->x();
    };
    const double left = std::min(column(1.7, 0.3), column(2.3, 0.3));
    const double right = std::max(column(1.7, -0.3), column(2.3, -0.3));
    for (int u = 0; u < a.cols; ++u) {
      const double change = difference(a.col(u).rowRange(80, 160), b.col(u).rowRange(80, 160));
      // It moves by up to 2 px while the shutter is open; the lens blur reaches 2 px.
      if (u > left + 4 && u < right - 4) {
        EXPECT_GT(change, 3.0) << u;
      } else if (u < left - 4 || u > right + 4) {
        EXPECT_EQ(change, 0.0) << u;
      }
    }
  }
}

TEST(ImageSimulator, KnowsWhatAPixelSeesAndWhetherAPointIsSeen) {
  const auto camera = vins::camera_model::testing::exampleCameras().front();
  const ImageSimulator simulator(sharedRoom(), camera, forwardCamera(), noiseFree(), 1, "cam0");
  const Pose T_wb = roomTrajectory(3.0);
  const Pose T_wc = T_wb * forwardCamera();
  for (double u = 20.0; u < 752.0; u += 60.0) {
    const Vector2d pixel(u, 100.0 + 0.3 * u);
    const auto p_w = simulator.pointAt(T_wb, pixel, 3.0);
    ASSERT_TRUE(p_w);
    EXPECT_LT((*simulator.project(T_wb, *p_w) - pixel).norm(), 1e-6);
    EXPECT_TRUE(simulator.isVisible(T_wb, *p_w, 3.0));
    const Vector3d behind = T_wc.position + 1.01 * (*p_w - T_wc.position);
    EXPECT_FALSE(simulator.isVisible(T_wb, behind, 3.0));
    const Vector3d in_front = T_wc.position + 0.9 * (*p_w - T_wc.position);
    EXPECT_TRUE(simulator.isVisible(T_wb, in_front, 3.0));
  }
  EXPECT_FALSE(simulator.isVisible(T_wb, T_wc * Vector3d(0.0, 0.0, -1.0), 3.0)) << "behind";
}

TEST(ImageSimulator, BlackoutIsBlackButForReadNoise) {
  ImageOptions options;
  options.blackouts = {{1.0, 2.0}};
  const ImageSimulator simulator(sharedRoom(), idealPinhole(), forwardCamera(), options, 1, "cam0");
  EXPECT_LT(cv::mean(simulator.render(roomTrajectory, 1.0, 0))[0], 1.0);
  EXPECT_GT(cv::mean(simulator.render(roomTrajectory, 2.0, 1))[0], 40.0);
}

}  // namespace
}  // namespace vins::simulation
