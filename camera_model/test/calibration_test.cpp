#include "camera_model/calibration.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>

#include "camera_model/calibration_drawing.h"
#include "camera_model/testing/example_cameras.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"
#include "vins_core/testing/shared_data.h"

namespace vins::camera_model {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNoise = 0.15;  ///< of a coordinate of a simulated corner [px]
const Chessboard kBoard{9, 7, 0.04};

/// Views of the board through a camera: the board is held towards a random pixel, tilted at random.
class BoardSimulator {
 public:
  BoardSimulator(const Camera& camera, std::uint64_t seed) : camera_(camera), random_(seed) {}

  std::vector<CalibrationView> views(int count, double noise) {
    std::vector<CalibrationView> views;
    while (static_cast<int>(views.size()) < count) {
      const auto corners = project(pose());
      if (!corners) continue;
      views.push_back({"view " + std::to_string(views.size()), *corners});
      for (Vector2d& corner : views.back().corners) {
        corner += noise * Vector2d(normal_(random_), normal_(random_));
      }
    }
    return views;
  }

 private:
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  /// A board with one of its outermost corners on the ray of a random pixel, facing the camera to
  /// 45 degrees.
  Pose pose() {
    const ImageSize size = camera_.imageSize();
    const auto ray = camera_.unproject({uniform(0, size.width), uniform(0, size.height)});
    if (!ray) return pose();
    const Eigen::Quaterniond facing = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), *ray);
    const Eigen::Quaterniond tilt =
        so3::exp({uniform(-0.8, 0.8), uniform(-0.8, 0.8), uniform(-3, 3)});
    const Eigen::Quaterniond R_cb = facing * tilt;
    const Vector3d aimed(uniform(-1, 1) > 0 ? 0.32 : 0.0, uniform(-1, 1) > 0 ? 0.24 : 0.0, 0.0);
    return {R_cb, uniform(0.2, 0.6) * *ray - R_cb * aimed};
  }

  std::optional<std::vector<Vector2d>> project(const Pose& T_cb) const {
    std::vector<Vector2d> corners;
    for (const Vector3d& point : kBoard.points()) {
      const auto pixel = camera_.project(T_cb * point);
      if (!pixel || !camera_.contains(*pixel, 5.0)) return std::nullopt;
      corners.push_back(*pixel);
    }
    return corners;
  }

  const Camera& camera_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

CalibrationOptions optionsFor(const Camera& camera) {
  CalibrationOptions options;
  options.model = camera.model();
  options.image_size = camera.imageSize();
  options.board = kBoard;
  options.estimate_k3 = false;
  return options;
}

/// Focal length at the centre of the image [px/rad], whatever the model calls it.
double focalLength(const Camera& camera, int axis) {
  ProjectionJacobians jacobians;
  camera.project({0.0, 0.0, 1.0}, &jacobians);
  return jacobians.J_pixel_point(axis, axis);
}

/// Largest distance of the two cameras' pixels over the part of the image that had corners, a
/// rotation between them (which the board's poses take up) fitted away [px].
double largestDifference(const Camera& truth, const Camera& estimate,
                         const std::vector<CalibrationView>& views) {
  const Vector2d center(0.5 * truth.imageSize().width, 0.5 * truth.imageSize().height);
  double reach = 0.0;
  for (const CalibrationView& view : views) {
    for (const Vector2d& corner : view.corners) reach = std::max(reach, (corner - center).norm());
  }
  std::vector<Vector3d> from, to;
  for (int v = 10; v < truth.imageSize().height; v += 20) {
    for (int u = 10; u < truth.imageSize().width; u += 20) {
      const auto a = truth.unproject(Vector2d(u, v)), b = estimate.unproject(Vector2d(u, v));
      if (!a || !b || (Vector2d(u, v) - center).norm() > reach) continue;
      from.push_back(*a);
      to.push_back(*b);
    }
  }
  const Eigen::Map<const Eigen::Matrix3Xd> A(from[0].data(), 3, static_cast<int>(from.size()));
  const Eigen::Map<const Eigen::Matrix3Xd> B(to[0].data(), 3, static_cast<int>(to.size()));
  const Eigen::Matrix3d R = Eigen::umeyama(A, B, false).topLeftCorner<3, 3>();
  double largest = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto a = truth.project(from[i]), b = estimate.project(R * from[i]);
    if (a && b) largest = std::max(largest, (*a - *b).norm());
  }
  return largest;
}

class SimulatedCalibration : public ::testing::TestWithParam<std::shared_ptr<const Camera>> {};

TEST_P(SimulatedCalibration, RecoversTheCameraToATenthOfAPercent) {
  const Camera& truth = *GetParam();
  const auto views = BoardSimulator(truth, 1).views(60, kNoise);
  const Calibration calibration = calibrate(optionsFor(truth), views);
  for (int axis = 0; axis < 2; ++axis) {
    const double f = focalLength(truth, axis);
    EXPECT_NEAR(focalLength(*calibration.camera, axis), f, 0.001 * f);
  }
  EXPECT_LT(largestDifference(truth, *calibration.camera, views), 0.5);
  // sqrt(2) of a coordinate's noise, less the freedoms taken: 6 a view and the camera's own.
  const double freedom = 1.0 - (6.0 * 60 + 9) / (2.0 * 60 * 63);
  // Four deviations of a root mean square of 7560 numbers.
  EXPECT_NEAR(calibration.rms, kNoise * std::sqrt(2.0 * freedom), 0.04 * kNoise * std::sqrt(2.0));
  EXPECT_EQ(calibration.corners_left_out, 0);
  for (const std::string& warning : calibration.warnings) ADD_FAILURE() << warning;
}

TEST_P(SimulatedCalibration, IsExactWithoutNoise) {
  const Camera& truth = *GetParam();
  const auto views = BoardSimulator(truth, 2).views(15, 0.0);
  const Calibration calibration = calibrate(optionsFor(truth), views);
  EXPECT_LT(calibration.rms, 1e-5);
  EXPECT_LT(largestDifference(truth, *calibration.camera, views), 1e-2);
}

/// The double sphere has a second pair of xi and alpha, far from the true one, that maps nearly
/// alike: from 25 views it may fit as well (by a chi-square that is lower by 1.3 in one of six
/// runs). The deviations describe the neighbourhood of one pair.
bool isTheOtherDoubleSphere(const Camera& truth, const Camera& estimate) {
  return truth.model() == CameraModel::kDoubleSphere &&
         std::abs(estimate.parameters()[0] - truth.parameters()[0]) > 0.2;
}

TEST_P(SimulatedCalibration, DeviationsTellTheErrors) {
  // Normalized squared errors of the parameters over several runs: the mean is 1 for honest
  // deviations; the bounds are those of a chi-square of a dozen runs, widened for parameters that
  // are correlated.
  const Camera& truth = *GetParam();
  double sum = 0.0;
  int count = 0, runs = 0;
  for (std::uint64_t seed = 10; seed < 16; ++seed) {
    const auto views = BoardSimulator(truth, seed).views(25, kNoise);
    const Calibration calibration = calibrate(optionsFor(truth), views);
    ASSERT_GT(calibration.covariance.size(), 0);
    if (isTheOtherDoubleSphere(truth, *calibration.camera)) {
      EXPECT_LT(largestDifference(truth, *calibration.camera, views), 0.5);
      continue;
    }
    ++runs;
    const CameraParameters error = calibration.camera->parameters() - truth.parameters();
    for (int i = 0; i < error.size(); ++i) {
      if (calibration.covariance(i, i) == 0.0) continue;
      sum += error[i] * error[i] / calibration.covariance(i, i);
      ++count;
    }
  }
  EXPECT_GE(runs, 5);
  EXPECT_GT(sum / count, 0.3);
  EXPECT_LT(sum / count, 2.5);
}

TEST_P(SimulatedCalibration, LeavesOutWrongCornersAndWrongViews) {
  const Camera& truth = *GetParam();
  auto views = BoardSimulator(truth, 3).views(20, kNoise);
  std::mt19937_64 random(4);
  for (int i = 0; i < 30; ++i) {
    views[random() % 19].corners[random() % 63] += Vector2d(4.0, -5.0);
  }
  for (std::size_t j = 0; j < 30; ++j)
    std::swap(views[19].corners[j], views[19].corners[62 - 2 * j]);
  const Calibration calibration = calibrate(optionsFor(truth), views);
  EXPECT_GE(calibration.corners_left_out, 25);
  EXPECT_LE(calibration.corners_left_out, 40);
  EXPECT_FALSE(calibration.views[19].used);
  EXPECT_LT(largestDifference(truth, *calibration.camera, views), 1.0);
}

INSTANTIATE_TEST_SUITE_P(AllModels, SimulatedCalibration,
                         ::testing::ValuesIn(vins::camera_model::testing::exampleCameras()),
                         [](const auto& info) { return info.param->name(); });

TEST(Calibration, WarnsWhereViewsAreTooWeak) {
  const auto truth = vins::camera_model::testing::exampleCameras()[0];
  // Boards straight ahead, all facing the same way, in the middle of the image.
  std::vector<CalibrationView> views;
  for (int i = 0; i < 5; ++i) {
    CalibrationView view{"flat " + std::to_string(i), {}};
    for (const Vector3d& p : kBoard.points()) {
      view.corners.push_back(*truth->project(p + Vector3d(-0.16, -0.12, 1.0 + 0.1 * i)) +
                             0.1 *
                                 Vector2d(std::sin(99.0 * p.x() + i), std::sin(77.0 * p.y() + i)));
    }
    views.push_back(view);
  }
  const Calibration calibration = calibrate(optionsFor(*truth), views);
  std::string all;
  for (const std::string& warning : calibration.warnings) all += warning + "\n";
  for (const char* word : {"only 5 views", "cover", "half-diagonal", "face the same way"}) {
    EXPECT_NE(all.find(word), std::string::npos) << word << " is missing in:\n" << all;
  }
}

TEST(Calibration, RefusesWhatCannotBeCalibrated) {
  const auto truth = vins::camera_model::testing::exampleCameras()[0];
  auto views = BoardSimulator(*truth, 5).views(6, 0.1);
  const CalibrationOptions options = optionsFor(*truth);
  EXPECT_THROW(calibrate(options, {views[0], views[1]}), InputError);
  auto short_view = views;
  short_view[2].corners.pop_back();
  EXPECT_THROW(calibrate(options, short_view), InputError);
  auto outside = views;
  outside[2].corners[5].x() = 800.0;
  EXPECT_THROW(calibrate(options, outside), InputError);
  auto nan = views;
  nan[2].corners[5].x() = std::nan("");
  EXPECT_THROW(calibrate(options, nan), InputError);
  auto nonsense = views;
  std::mt19937_64 random(6);
  for (CalibrationView& view : nonsense)
    std::shuffle(view.corners.begin(), view.corners.end(), random);
  EXPECT_THROW(calibrate(options, nonsense), InputError);
  CalibrationOptions no_size = options;
  no_size.image_size = {};
  EXPECT_THROW(calibrate(no_size, views), InputError);
}

TEST(Calibration, PicturesShowTheCorners) {
  const auto truth = vins::camera_model::testing::exampleCameras()[0];
  const auto views = BoardSimulator(*truth, 7).views(10, kNoise);
  const CalibrationOptions options = optionsFor(*truth);
  const Calibration calibration = calibrate(options, views);
  const cv::Mat coverage = drawCoverage(options.image_size, views, calibration);
  const cv::Mat residuals = drawResiduals(options.image_size, views, calibration);
  EXPECT_GT(coverage.rows, 480);
  EXPECT_EQ(coverage.cols, 752);
  EXPECT_GT(residuals.cols, 752 + 400);
  int dots = 0;
  for (const Vector2d& corner : views[0].corners) {
    const auto& pixel = coverage.at<cv::Vec3b>(cvRound(corner.y()), cvRound(corner.x()));
    dots += std::min({pixel[0], pixel[1], pixel[2]}) < 200 ? 1 : 0;
  }
  // The cells' counts may cover a few of the 63.
  EXPECT_GE(dots, 50);
}

class RealChessboard : public ::testing::TestWithParam<std::string> {};

TEST_P(RealChessboard, FitsNoWorseThanOpencvOnTheSameCorners) {
  const std::string folder = vins::testing::sharedData("chessboard");
  VINS_SKIP_WITHOUT(folder);
  CalibrationOptions options;
  options.board = {9, 6, 25.0};
  options.reject_outliers = false;
  std::vector<CalibrationView> views;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(GetParam(), 0) != 0) continue;
    const cv::Mat gray = cv::imread(entry.path().string(), cv::IMREAD_GRAYSCALE);
    options.image_size = {gray.cols, gray.rows};
    const auto corners = detectChessboard(gray, options.board);
    if (corners) views.push_back({name, *corners});
  }
  ASSERT_GE(views.size(), 12u);

  std::vector<std::vector<cv::Point3f>> points;
  std::vector<std::vector<cv::Point2f>> corners;
  for (const CalibrationView& view : views) {
    points.emplace_back();
    corners.emplace_back();
    for (const Vector3d& p : options.board.points()) {
      points.back().emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0F);
    }
    for (const Vector2d& c : view.corners) {
      corners.back().emplace_back(static_cast<float>(c.x()), static_cast<float>(c.y()));
    }
  }
  for (const bool estimate_k3 : {true, false}) {
    options.estimate_k3 = estimate_k3;
    cv::Mat K, distortion;
    std::vector<cv::Mat> rotations, translations;
    const double opencv = cv::calibrateCamera(
        points, corners, {options.image_size.width, options.image_size.height}, K, distortion,
        rotations, translations, estimate_k3 ? 0 : cv::CALIB_FIX_K3);
    const Calibration calibration = calibrate(options, views);
    std::cout << GetParam() << (estimate_k3 ? " with k3" : " without k3") << ": rms "
              << calibration.rms << " px, OpenCV's " << opencv << " px\n";
    // Both minimize the same sum; the slack is for where they stop.
    EXPECT_LE(calibration.rms, opencv * (1.0 + 1e-6));
  }
}

INSTANTIATE_TEST_SUITE_P(Photographs, RealChessboard, ::testing::Values("left", "right"));

}  // namespace
}  // namespace vins::camera_model
