#include "vins_estimator/inertial/imu_intrinsics.h"

#include <gtest/gtest.h>

#include "estimator_test_values.h"
#include "vins_core/testing/numeric_jacobian.h"
#include "vins_estimator/inertial/preintegration.h"

namespace vins::estimator {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::wavingSamples;
using vins::testing::numericJacobian;

const ImuNoise kNoise{2.0e-3, 1.7e-4, 3.0e-3, 1.9e-5, 9.81};
const Vector3d kAccBias(0.05, -0.1, 0.08);
const Vector3d kGyrBias(0.01, 0.02, -0.015);

ImuIntrinsics someErrors() {
  ImuIntrinsics errors;
  for (int i = 0; i < errors.size(); ++i) errors(i) = 0.002 * (i % 4) - 0.003;
  return errors;
}

Preintegration integrated(const std::vector<ImuSample>& samples, const ImuIntrinsics& errors) {
  Preintegration imu(kNoise, kAccBias, kGyrBias, errors);
  imu.integrate(samples);
  return imu;
}

/// (alpha, theta, beta), theta from `from`'s rotation.
Eigen::Matrix<double, 9, 1> stacked(const Preintegration::Increments& d,
                                    const Eigen::Quaterniond& from) {
  Eigen::Matrix<double, 9, 1> all;
  all << d.alpha, so3::log(from.conjugate() * d.gamma), d.beta;
  return all;
}

TEST(ImuIntrinsics, GainsAreLinearInTheErrors) {
  const ImuIntrinsics errors = someErrors();
  const Vector3d a(0.4, -2.0, 9.6), w(0.3, -1.2, 0.7);
  EXPECT_LT((accelerometerGain(errors) * a - a -
             accelerometerGainJacobian(a) * errors.head<kAccelerometerIntrinsics>())
                .norm(),
            1e-14);
  EXPECT_LT((gyroscopeGain(errors) * w - w - gyroscopeGainJacobian(w) * errors.tail<9>()).norm(),
            1e-14);
  EXPECT_TRUE(accelerometerGain(errors).isLowerTriangular());
}

TEST(ImuIntrinsics, IntegrationTakesThemOffTheReadings) {
  const ImuIntrinsics errors = someErrors();
  std::vector<ImuSample> samples = wavingSamples(0.8, 200.0);
  const Preintegration imu = integrated(samples, errors);
  for (ImuSample& sample : samples) {
    sample.acceleration = accelerometerGain(errors) * (sample.acceleration - kAccBias) + kAccBias;
    sample.angular_velocity =
        gyroscopeGain(errors) * (sample.angular_velocity - kGyrBias) + kGyrBias;
  }
  const Preintegration right = integrated(samples, ImuIntrinsics::Zero());
  EXPECT_LT((imu.alpha() - right.alpha()).norm(), 1e-12);
  EXPECT_LT((imu.beta() - right.beta()).norm(), 1e-12);
  EXPECT_LT(so3::log(imu.gamma().conjugate() * right.gamma()).norm(), 1e-12);
}

TEST(ImuIntrinsics, JacobianIsThatOfNumericDifferences) {
  const auto samples = wavingSamples(0.8, 200.0);
  const Preintegration imu = integrated(samples, someErrors());
  const MatrixXd numeric = numericJacobian(
      [&](const VectorXd& d) -> VectorXd {
        const Preintegration moved = integrated(samples, someErrors() + d);
        return stacked({moved.alpha(), moved.gamma(), moved.beta()}, imu.gamma());
      },
      15);
  // The rotation is compared at the increments of `imu`, whose step the recursion takes to first
  // order: that leaves a thousandth.
  EXPECT_LT((imu.intrinsicsJacobian() - numeric).norm(), 2e-3 * numeric.norm());
}

TEST(ImuIntrinsics, CorrectionIsGoodToSecondOrder) {
  const auto samples = wavingSamples(0.8, 200.0);
  const Preintegration imu = integrated(samples, ImuIntrinsics::Zero());
  const auto error = [&](double size) {
    const ImuIntrinsics errors = size * someErrors();
    const Preintegration right = integrated(samples, errors);
    return (stacked(imu.corrected(kAccBias, kGyrBias, errors), imu.gamma()) -
            stacked({right.alpha(), right.gamma(), right.beta()}, imu.gamma()))
        .norm();
  };
  EXPECT_LT(error(1.0), 1e-4);
  EXPECT_NEAR(error(2.0) / error(1.0), 4.0, 1.0);
}

TEST(ImuIntrinsics, AskForReintegrationWhereTheyMoveFar) {
  const Preintegration imu = integrated(wavingSamples(0.8, 200.0), ImuIntrinsics::Zero());
  EXPECT_FALSE(imu.needsReintegration(kAccBias, kGyrBias, 1e-5 * ImuIntrinsics::Ones()));
  EXPECT_TRUE(imu.needsReintegration(kAccBias, kGyrBias, 0.02 * ImuIntrinsics::Ones()));
}

}  // namespace
}  // namespace vins::estimator
