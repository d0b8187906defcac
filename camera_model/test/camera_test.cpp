#include "camera_model/camera.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "camera_model/testing/example_cameras.h"
#include "vins_core/input_error.h"
#include "vins_core/testing/numeric_jacobian.h"

namespace vins::camera_model {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using testing::parametersOf;

/// Every model's example camera, and harder ones: strong tangential distortion, k3, a long lens,
/// xi on both sides of 1, sheared OCam, rational distortion.
std::vector<std::shared_ptr<const Camera>> cameras() {
  auto all = vins::camera_model::testing::exampleCameras();
  const ImageSize vga{640, 480};
  all.push_back(std::make_shared<PinholeRadtan>(
      "tangential", vga, parametersOf({530, 531, 342, 234, -0.28, 0.10, 0.004, -0.003, -0.04})));
  all.push_back(std::make_shared<PinholeRadtan>(
      "pincushion", vga, parametersOf({300, 310, 310, 250, 0.12, 0.05, -0.002, 0.001, 0.01})));
  all.push_back(std::make_shared<PinholeRadtan>(
      "rational", vga,
      parametersOf({430, 431, 318, 243, 9.5, 5.1, 2e-4, -1e-4, 0.25, 9.8, 8.3, 1.35})));
  all.push_back(std::make_shared<PinholeRadtan>(
      "wide rational", vga,
      parametersOf({504, 504, 320, 240, 0.5, -2.6, 3e-3, -2e-3, 1.5, 0.39, -2.4, 1.43})));
  all.push_back(std::make_shared<PinholeRadtan>(
      "ideal", vga, parametersOf({5000, 5000, 320, 240, 0, 0, 0, 0, 0})));
  all.push_back(std::make_shared<KannalaBrandt>("ideal equidistant", vga,
                                                parametersOf({0, 0, 0, 0, 150, 150, 320, 240})));
  all.push_back(std::make_shared<Mei>(
      "xi 0.6", vga, parametersOf({0.6, -0.2, 0.05, 1e-3, 2e-3, 420, 421, 321, 239})));
  all.push_back(
      std::make_shared<Mei>("xi 3", vga, parametersOf({3.0, 0.1, 0.2, 0, 0, 900, 900, 320, 240})));
  all.push_back(std::make_shared<Scaramuzza>(
      "sheared", vga,
      parametersOf({-300, 0.01, 9e-4, -2e-7, 1.5e-9, 0.97, 0.02, -0.015, 300, 250})));
  all.push_back(std::make_shared<DoubleSphere>("flat double sphere", vga,
                                               parametersOf({0.3, 0.4, 500, 510, 322, 238})));
  all.push_back(std::make_shared<DoubleSphere>("round double sphere", vga,
                                               parametersOf({-0.35, 0.75, 200, 200, 320, 240})));
  all.push_back(
      std::make_shared<Eucm>("flat eucm", vga, parametersOf({0.3, 1.4, 400, 400, 320, 240})));
  return all;
}

class CameraTest : public ::testing::TestWithParam<std::shared_ptr<const Camera>> {
 protected:
  const Camera& camera() const { return *GetParam(); }

  /// Points all around, more of them ahead.
  Vector3d point() {
    Vector3d p(normal_(random_), normal_(random_), normal_(random_) + 1.0);
    return 3.0 * p;
  }

  /// A point that the camera sees in its image, away from the border.
  std::optional<Vector3d> seenPoint() {
    std::uniform_real_distribution<double> share(0.02, 0.98);
    const ImageSize size = camera().imageSize();
    const auto bearing =
        camera().unproject({share(random_) * size.width, share(random_) * size.height});
    if (!bearing) return std::nullopt;
    return Vector3d((1.0 + 3.0 * share(random_)) * *bearing);
  }

  std::mt19937_64 random_{5};
  std::normal_distribution<double> normal_;
};

TEST_P(CameraTest, UnprojectionIsUndoneByProjectionAllOverTheImage) {
  const ImageSize size = camera().imageSize();
  int seen = 0, all = 0;
  for (double v = 0.0; v <= size.height - 1; v += (size.height - 1) / 40.0) {
    for (double u = 0.0; u <= size.width - 1; u += (size.width - 1) / 40.0) {
      ++all;
      const auto bearing = camera().unproject({u, v});
      if (!bearing) continue;
      ++seen;
      EXPECT_NEAR(bearing->norm(), 1.0, 1e-15);
      const auto pixel = camera().project(2.5 * *bearing);
      ASSERT_TRUE(pixel) << u << " " << v;
      EXPECT_LT((*pixel - Vector2d(u, v)).norm(), 1e-8) << u << " " << v;
    }
  }
  EXPECT_GT(seen, 0.7 * all);
}

TEST_P(CameraTest, ProjectionIsUndoneByUnprojectionWhereverItIsValid) {
  int valid = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vector3d p = point();
    const auto pixel = camera().project(p);
    if (!pixel) continue;
    ++valid;
    const auto bearing = camera().unproject(*pixel);
    ASSERT_TRUE(bearing) << p.transpose();
    EXPECT_LT((*bearing - p.normalized()).norm(), 1e-8) << p.transpose();
  }
  EXPECT_GT(valid, 2000);
}

TEST_P(CameraTest, CornersOfTheImageRoundTrip) {
  const ImageSize size = camera().imageSize();
  for (const double u : {0.0, size.width - 1.0}) {
    for (const double v : {0.0, size.height - 1.0}) {
      const auto bearing = camera().unproject({u, v});
      if (!bearing) continue;  // beyond the lens' image circle: said, not guessed
      const auto again = camera().unproject(*camera().project(*bearing));
      EXPECT_LT((*again - *bearing).norm(), 1e-8);
    }
  }
}

TEST_P(CameraTest, DependsOnTheDirectionOnly) {
  for (int i = 0; i < 200; ++i) {
    const Vector3d p = point();
    const auto near = camera().project(p), far = camera().project(1e6 * p);
    ASSERT_EQ(near.has_value(), far.has_value());
    if (!near) continue;
    EXPECT_LT((*near - *far).norm(), 1e-7 * (1.0 + near->norm()));
  }
}

TEST_P(CameraTest, TheAxisProjectsToTheCentre) {
  ProjectionJacobians at, beside;
  const auto pixel = camera().project({0.0, 0.0, 2.0}, &at);
  ASSERT_TRUE(pixel);
  EXPECT_LT((camera().unproject(*pixel).value() - Vector3d::UnitZ()).norm(), 1e-12);
  // The Jacobian has no seam where the formula for the axis takes over.
  for (const double offset : {1e-13, 1e-10, 1e-9, 1e-8}) {
    ASSERT_TRUE(camera().project({offset, -offset, 2.0}, &beside));
    EXPECT_LT((at.J_pixel_point - beside.J_pixel_point).norm(), 1e-4) << offset;
    EXPECT_LT((at.J_pixel_parameters - beside.J_pixel_parameters).norm(), 1e-4) << offset;
  }
}

/// Relative to the size of the Jacobian: its entries go from 1e-2 to 1e9 (p4 of OCam).
void expectColumnsNear(const Eigen::MatrixXd& J, const Eigen::MatrixXd& numeric, double tolerance) {
  for (int i = 0; i < J.cols(); ++i) {
    EXPECT_LT((J.col(i) - numeric.col(i)).norm(), tolerance * (1.0 + J.col(i).norm()))
        << "column " << i;
  }
}

TEST_P(CameraTest, PointJacobianAgreesWithNumericDifferences) {
  int valid = 0;
  for (int i = 0; i < 500; ++i) {
    const auto p = seenPoint();
    ProjectionJacobians jacobians;
    // Differences need the neighbourhood to be valid.
    if (!p || !camera().project(*p + Vector3d(0.0, 0.0, -0.01) * p->norm())) continue;
    ASSERT_TRUE(camera().project(*p, &jacobians));
    ++valid;
    const auto f = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return *camera().project(*p + Vector3d(d));
    };
    const Eigen::MatrixXd numeric = vins::testing::numericJacobian(f, 3, 1e-4 * p->norm());
    expectColumnsNear(jacobians.J_pixel_point, numeric, 1e-7);
  }
  EXPECT_GT(valid, 300);
}

TEST_P(CameraTest, ParameterJacobianAgreesWithNumericDifferences) {
  const CameraParameters p0 = camera().parameters();
  int compared = 0;
  for (int i = 0; i < 60; ++i) {
    const auto p = seenPoint();
    ProjectionJacobians jacobians;
    if (!p || !camera().project(*p, &jacobians)) continue;
    for (int k = 0; k < p0.size(); ++k) {
      const Eigen::MatrixXd J = jacobians.J_pixel_parameters.col(k);
      // A step that moves the pixel by about a hundredth.
      const double step = 0.01 / (1e-9 + J.norm());
      if (step > 1.0) continue;
      ++compared;
      const auto f = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
        CameraParameters moved = p0;
        moved[k] += d[0];
        return *camera().withParameters(moved)->project(*p);
      };
      expectColumnsNear(J, vins::testing::numericJacobian(f, 1, step), 1e-7);
    }
  }
  EXPECT_GT(compared, 200);
}

TEST_P(CameraTest, ScalingTheImageScalesThePixels) {
  const ImageSize size = camera().imageSize();
  const ImageSize scaled{size.width / 2, size.height * 3 / 2};
  const auto small = camera().scaledTo(scaled);
  EXPECT_EQ(small->imageSize(), scaled);
  for (int i = 0; i < 200; ++i) {
    const Vector3d p = point();
    const auto pixel = camera().project(p);
    const auto other = small->project(p);
    if (!pixel || !camera().contains(*pixel)) continue;
    ASSERT_TRUE(other);
    const Vector2d expected((pixel->x() + 0.5) * scaled.width / size.width - 0.5,
                            (pixel->y() + 0.5) * scaled.height / size.height - 0.5);
    EXPECT_LT((*other - expected).norm(), 1e-8);
  }
}

TEST_P(CameraTest, SaysSoWhereItCannotSee) {
  EXPECT_FALSE(camera().project({0.0, 0.0, 0.0}));
  EXPECT_FALSE(camera().project({0.0, 0.0, -1.0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(camera().project({nan, 0.0, 1.0}));
  EXPECT_FALSE(camera().project({0.1, 0.0, nan}));
  EXPECT_FALSE(camera().unproject({nan, 10.0}));
  EXPECT_FALSE(camera().unproject({1e15, 1e15}));
}

TEST_P(CameraTest, KeepsItsParameters) {
  const auto copy = camera().withParameters(camera().parameters());
  EXPECT_EQ(copy->parameters(), camera().parameters());
  EXPECT_EQ(copy->name(), camera().name());
  EXPECT_EQ(copy->model(), camera().model());
  EXPECT_EQ(static_cast<int>(camera().parameterNames().size()), camera().parameters().size());
  EXPECT_LE(camera().parameters().size(), kMaxCameraParameters);
}

TEST_P(CameraTest, RefusesParametersThatDescribeNoCamera) {
  const CameraParameters p = camera().parameters();
  EXPECT_THROW(camera().withParameters(p.head(p.size() - 1)), InputError);
  CameraParameters nan = p;
  nan[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(camera().withParameters(nan), InputError);
  EXPECT_THROW(camera().withParameters(CameraParameters(-p.cwiseAbs())), InputError);
}

INSTANTIATE_TEST_SUITE_P(AllModels, CameraTest, ::testing::ValuesIn(cameras()),
                         [](const auto& info) {
                           std::string name = info.param->name();
                           for (char& c : name) c = std::isalnum(c) != 0 ? c : '_';
                           return name;
                         });

TEST(PinholeRadtan, SeesNothingBehindOrBeyondTheFoldOfItsDistortion) {
  const auto camera = vins::camera_model::testing::exampleCameras()[0];
  EXPECT_FALSE(camera->project({0.1, 0.1, -1.0}));
  EXPECT_FALSE(camera->project({0.1, 0.1, 0.0}));
  // 1 + 3 k1 r^2 = 0 at r = 1: from there on points would fold back into the image.
  const PinholeRadtan folding("folding", {640, 480},
                              parametersOf({300, 300, 320, 240, -1.0 / 3.0, 0, 0, 0, 0}));
  EXPECT_TRUE(folding.project({0.9, 0.0, 1.0}));
  EXPECT_FALSE(folding.project({1.0, 0.0, 1.0}));
  EXPECT_FALSE(folding.project({1.6, 0.0, 1.0}));
  EXPECT_FALSE(folding.unproject({320 + 0.7 * 300, 240}));
}

TEST(PinholeRadtan, SeesNothingBeyondTheFoldOfRationalDistortion) {
  // r / (1 + r^2) has its maximum 1/2 at r = 1; beyond it points would fold back.
  const PinholeRadtan folding("folding", {640, 480},
                              parametersOf({300, 300, 320, 240, 0, 0, 0, 0, 0, 1, 0, 0}));
  EXPECT_TRUE(folding.project({0.95, 0.0, 1.0}));
  EXPECT_FALSE(folding.project({1.0, 0.0, 1.0}));
  EXPECT_FALSE(folding.project({1.6, 0.0, 1.0}));
  EXPECT_FALSE(folding.unproject({320 + 0.51 * 300, 240}));
  // 1 / (1 - r^4) has a pole at r = 1, and is negative beyond it.
  const PinholeRadtan pole("pole", {640, 480},
                           parametersOf({300, 300, 320, 240, 0, 0, 0, 0, 0, 0, -1, 0}));
  EXPECT_TRUE(pole.project({0.95, 0.0, 1.0}));
  EXPECT_FALSE(pole.project({1.0, 0.0, 1.0}));
  EXPECT_FALSE(pole.project({1.2, 0.0, 1.0}));
}

TEST(PinholeRadtan, WithoutADenominatorRationalDistortionIsThePolynomial) {
  const ImageSize vga{640, 480};
  const PinholeRadtan polynomial(
      "polynomial", vga, parametersOf({530, 531, 342, 234, -0.28, 0.10, 0.004, -0.003, -0.04}));
  const PinholeRadtan rational(
      "rational", vga,
      parametersOf({530, 531, 342, 234, -0.28, 0.10, 0.004, -0.003, -0.04, 0, 0, 0}));
  for (const Vector3d& p : {Vector3d(0.1, 0.2, 1.0), Vector3d(-0.5, 0.3, 1.0)}) {
    EXPECT_EQ(*polynomial.project(p), *rational.project(p));
  }
  EXPECT_EQ(*polynomial.unproject({100, 50}), *rational.unproject({100, 50}));
}

TEST(KannalaBrandt, SeesBehindItself) {
  const KannalaBrandt camera("wide", {640, 480}, parametersOf({0, 0, 0, 0, 100, 100, 320, 240}));
  const auto pixel = camera.project({1.0, 0.0, -0.5});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 320 + 100 * std::atan2(1.0, -0.5), 1e-12);
}

TEST(Mei, SeesNothingBelowTheFoldOfTheSphere) {
  const Mei camera("mirror", {640, 480}, parametersOf({2.0, 0, 0, 0, 0, 400, 400, 320, 240}));
  // For xi = 2 bearings fold over at z = -1/2.
  EXPECT_TRUE(camera.project({std::sqrt(1.0 - 0.45 * 0.45), 0.0, -0.45}));
  EXPECT_FALSE(camera.project({std::sqrt(1.0 - 0.55 * 0.55), 0.0, -0.55}));
  EXPECT_FALSE(camera.unproject({320 + 400 / std::sqrt(3.0), 240}));
}

TEST(DoubleSphere, WithOneSphereIsTheUnifiedCamera) {
  // xi = 0 leaves Mei's model of xi' = alpha / (1 - alpha), gamma = f / (1 - alpha).
  const DoubleSphere camera("ds", {640, 480}, parametersOf({0.0, 0.6, 200, 210, 320, 240}));
  const Mei same("mei", {640, 480}, parametersOf({1.5, 0, 0, 0, 0, 500, 525, 320, 240}));
  const Eucm eucm("eucm", {640, 480}, parametersOf({0.6, 1.0, 200, 210, 320, 240}));
  for (const Vector3d& p : {Vector3d(1, 2, 3), Vector3d(-1, 0.5, 0.1), Vector3d(0.7, -0.3, -0.2)}) {
    EXPECT_LT((*camera.project(p) - *same.project(p)).norm(), 1e-9);
    EXPECT_LT((*eucm.project(p) - *same.project(p)).norm(), 1e-9);
  }
}

TEST(DoubleSphere, WithAlphaZeroAndXiZeroIsAPinhole) {
  const DoubleSphere camera("ds", {640, 480}, parametersOf({0.0, 0.0, 400, 410, 320, 240}));
  const auto pixel = camera.project({0.3, -0.2, 2.0});
  EXPECT_LT((*pixel - Vector2d(320 + 400 * 0.15, 240 - 410 * 0.1)).norm(), 1e-12);
  EXPECT_FALSE(camera.project({0.3, -0.2, -2.0}));
}

TEST(DoubleSphere, SeesBehindItselfButNotBeyondTheFold) {
  const DoubleSphere camera("ds", {512, 512}, parametersOf({-0.17, 0.59, 158, 158, 255, 256}));
  const auto at = [](double degrees) {
    const double angle = degrees * M_PI / 180.0;
    return Vector3d(std::sin(angle), 0.0, std::cos(angle));
  };
  EXPECT_TRUE(camera.project(at(100.0)));
  EXPECT_FALSE(camera.project(at(170.0)));
  double last = 0.0;
  for (double degrees = 1.0; degrees < 180.0; degrees += 1.0) {
    const auto pixel = camera.project(at(degrees));
    if (!pixel) break;
    EXPECT_GT(pixel->x(), last) << "folds at " << degrees << " degrees";
    last = pixel->x();
  }
}

TEST(UnifiedCameras, RefuseParametersOutsideOfTheirModels) {
  const ImageSize vga{640, 480};
  EXPECT_THROW(DoubleSphere("c", vga, parametersOf({1.5, 0.5, 1, 1, 0, 0})), InputError);
  EXPECT_THROW(DoubleSphere("c", vga, parametersOf({0.0, 1.1, 1, 1, 0, 0})), InputError);
  EXPECT_THROW(Eucm("c", vga, parametersOf({-0.1, 1.0, 1, 1, 0, 0})), InputError);
  EXPECT_THROW(Eucm("c", vga, parametersOf({0.5, 0.0, 1, 1, 0, 0})), InputError);
}

TEST(Camera, ContainsPixelsOfTheImage) {
  const auto camera = vins::camera_model::testing::exampleCameras()[0];
  EXPECT_TRUE(camera->contains({0.0, 0.0}));
  EXPECT_TRUE(camera->contains({751.0, 479.0}));
  EXPECT_FALSE(camera->contains({751.1, 479.0}));
  EXPECT_FALSE(camera->contains({3.0, 9.0}, 5.0));
}

TEST(Camera, ModelNamesAreReadInAnySpelling) {
  EXPECT_EQ(cameraModelFromString("kannala-brandt"), CameraModel::kKannalaBrandt);
  EXPECT_EQ(cameraModelFromString("KANNALA_BRANDT"), CameraModel::kKannalaBrandt);
  EXPECT_EQ(cameraModelFromString("Pinhole"), CameraModel::kPinhole);
  EXPECT_EQ(cameraModelFromString("double-sphere"), CameraModel::kDoubleSphere);
  EXPECT_THROW(cameraModelFromString("fisheye"), InputError);
}

}  // namespace
}  // namespace vins::camera_model
