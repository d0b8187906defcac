#include "vins_estimator/inertial/preintegration.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "estimator_test_values.h"
#include "vins_core/testing/numeric_jacobian.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;
using testing::Random;
using testing::wavingSamples;

const ImuNoise kNoise{2.0e-3, 1.7e-4, 3.0e-3, 1.9e-5, 9.81};
const Vector3d kAccBias_(0.05, -0.1, 0.08);
const Vector3d kGyrBias_(0.01, 0.02, -0.015);

Preintegration integrated(const std::vector<ImuSample>& samples, const Vector3d& ba = kAccBias_,
                          const Vector3d& bg = kGyrBias_) {
  Preintegration imu(kNoise, ba, bg);
  imu.integrate(samples);
  return imu;
}

/// Errors (alpha, theta, beta) of `imu` against `truth`.
Eigen::Matrix<double, 9, 1> errors(const Preintegration& imu, const Preintegration& truth) {
  Eigen::Matrix<double, 9, 1> e;
  e << imu.alpha() - truth.alpha(), so3::log(truth.gamma().conjugate() * imu.gamma()),
      imu.beta() - truth.beta();
  return e;
}

TEST(Preintegration, ConstantReadingsHaveAClosedForm) {
  std::vector<ImuSample> samples(101);
  for (int k = 0; k <= 100; ++k) {
    samples[k].stamp = 5'000'000 * k;
    samples[k].acceleration = {0.3, -0.2, 9.0};
  }
  const Preintegration imu = integrated(samples, Vector3d::Zero(), Vector3d::Zero());
  EXPECT_NEAR(imu.duration(), 0.5, 1e-12);
  EXPECT_LT((imu.beta() - 0.5 * Vector3d(0.3, -0.2, 9.0)).norm(), 1e-12);
  EXPECT_LT((imu.alpha() - 0.125 * Vector3d(0.3, -0.2, 9.0)).norm(), 1e-12);
  EXPECT_LT(so3::log(imu.gamma()).norm(), 1e-12);
}

TEST(Preintegration, ErrorFallsWithTheSquareOfTheRate) {
  const Preintegration finest = integrated(wavingSamples(1.0, 20000.0));
  const double at_200 = errors(integrated(wavingSamples(1.0, 200.0)), finest).norm();
  const double at_2000 = errors(integrated(wavingSamples(1.0, 2000.0)), finest).norm();
  // At ten times the rate a second-order rule errs a hundredth; the finest errs a ten-thousandth.
  // The rule's own error is dt^2 / 12 times the change of slope, here up to 80 m/s^3: 1.7e-4.
  EXPECT_LT(at_200, 2e-4);
  EXPECT_NEAR(at_200 / at_2000, 100.0, 5.0);
}

TEST(Preintegration, BiasJacobiansAreThoseOfNumericDifferences) {
  const auto samples = wavingSamples(0.8, 200.0);
  const Preintegration imu = integrated(samples);
  const auto f = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
    return errors(integrated(samples, kAccBias_ + d.head<3>(), kGyrBias_ + d.tail<3>()), imu);
  };
  const Eigen::MatrixXd numeric = vins::testing::numericJacobian(f, 6);
  EXPECT_LT((imu.jacobian().block<9, 6>(0, kAccBias) - numeric).norm(), 1e-9 * numeric.norm());
}

TEST(Preintegration, CorrectionIsOfFirstOrder) {
  const auto samples = wavingSamples(0.5, 200.0);
  const Preintegration imu = integrated(samples);
  const auto errorOf = [&](double scale) {
    const Vector3d ba = kAccBias_ + scale * Vector3d(0.02, -0.01, 0.03);
    const Vector3d bg = kGyrBias_ + scale * Vector3d(-0.004, 0.003, 0.005);
    const Preintegration exact = integrated(samples, ba, bg);
    const auto corrected = imu.corrected(ba, bg);
    return (corrected.alpha - exact.alpha()).norm() + (corrected.beta - exact.beta()).norm() +
           so3::log(exact.gamma().conjugate() * corrected.gamma).norm();
  };
  EXPECT_NEAR(errorOf(2.0) / errorOf(1.0), 4.0, 0.2);
  EXPECT_LT(errorOf(1.0), 1e-4);
}

TEST(Preintegration, AsksForReintegrationWhenTheBiasMovedFar) {
  Preintegration imu = integrated(wavingSamples(0.5, 200.0));
  EXPECT_FALSE(imu.needsReintegration(kAccBias_, kGyrBias_, imu.intrinsics()));
  const Vector3d far = kGyrBias_ + Vector3d(0.0, 0.02, 0.0);
  EXPECT_TRUE(imu.needsReintegration(kAccBias_, far, imu.intrinsics()));
  EXPECT_TRUE(
      imu.needsReintegration(kAccBias_ + Vector3d(0.0, 0.2, 0.0), kGyrBias_, imu.intrinsics()));
  imu.reintegrate(kAccBias_, far);
  EXPECT_FALSE(imu.needsReintegration(kAccBias_, far, imu.intrinsics()));
  const Preintegration anew = integrated(wavingSamples(0.5, 200.0), kAccBias_, far);
  EXPECT_EQ(imu.alpha(), anew.alpha());
  EXPECT_EQ(imu.covariance(), anew.covariance());
}

TEST(Preintegration, PiecesAppendedAreOneInterval) {
  const auto samples = wavingSamples(0.6, 200.0);
  const std::vector<ImuSample> head(samples.begin(), samples.begin() + 61);
  const std::vector<ImuSample> tail(samples.begin() + 60, samples.end());
  Preintegration joined = integrated(head);
  joined.append(integrated(tail));
  const Preintegration whole = integrated(samples);
  EXPECT_LT(errors(joined, whole).norm(), 1e-13);
  EXPECT_NEAR(joined.duration(), whole.duration(), 1e-12);
  EXPECT_LT((joined.covariance() - whole.covariance()).norm(), 1e-15);
}

TEST(Preintegration, PredictionIsTheIntegratedMotion) {
  Random random(4);
  const Vector3d g_w(0.0, 0.0, -9.81);
  NavState state = random.navState();
  const auto samples = wavingSamples(0.4, 200.0);
  const Preintegration imu = integrated(samples, state.accelerometer_bias, state.gyroscope_bias);
  const NavState predicted = imu.predict(state, g_w);
  // The same by integrating in the world.
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const double dt = toSeconds(samples[k].stamp - samples[k - 1].stamp);
    const Vector3d w = 0.5 * (samples[k - 1].angular_velocity + samples[k].angular_velocity) -
                       state.gyroscope_bias;
    const Vector3d a0 =
        state.T_wb.rotation * (samples[k - 1].acceleration - state.accelerometer_bias);
    state.T_wb.rotation = state.T_wb.rotation * so3::exp(dt * w);
    const Vector3d a1 = state.T_wb.rotation * (samples[k].acceleration - state.accelerometer_bias);
    const Vector3d a = 0.5 * (a0 + a1) + g_w;
    state.T_wb.position += dt * state.v_w + 0.5 * dt * dt * a;
    state.v_w += dt * a;
  }
  EXPECT_LT(minus(predicted, state).norm(), 1e-12);
}

TEST(Preintegration, SquareRootOfTheInformationFitsTheCovariance) {
  const Preintegration imu = integrated(wavingSamples(0.2, 200.0));
  const Matrix15d& S = imu.sqrtInformation();
  EXPECT_TRUE(S.isLowerTriangular());
  // With the floor of the deviations that the header tells of.
  Vector15d least = Vector15d::Constant(1e-6);
  least.segment<3>(kRotation).setConstant(3e-7);
  least.segment<3>(kGyrBias).setConstant(3e-7);
  Matrix15d covariance = imu.covariance();
  covariance.diagonal() += least.cwiseAbs2();
  EXPECT_LT((S * covariance * S.transpose() - Matrix15d::Identity()).norm(), 1e-6);
}

TEST(Preintegration, IntervalsOfAnyLengthAreWellConditioned) {
  for (const double rate : {50.0, 100.0, 200.0, 1000.0}) {
    for (const double duration : {1e-6, 1e-4, 1.5e-3, 4e-3, 0.01, 0.05, 0.5}) {
      // Two samples where the interval is shorter than a period, as after interpolation.
      const auto samples = wavingSamples(duration, std::max(rate, 1.0 / duration));
      const Preintegration imu = integrated(samples);
      ASSERT_TRUE(imu.isWeightable()) << rate << " Hz, " << duration << " s";
      const Matrix15d& S = imu.sqrtInformation();
      ASSERT_TRUE(S.allFinite());
      // Scaled by its deviations, no direction is better known than others by more than 1e4.
      const Vector15d sigma = (S.transpose() * S).inverse().diagonal().cwiseSqrt();
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(S * sigma.asDiagonal());
      EXPECT_LT(svd.singularValues()(0) / svd.singularValues()(14), 1e4)
          << rate << " Hz, " << duration << " s";
      EXPECT_LT(S.diagonal().maxCoeff(), 1e7);
    }
  }
}

TEST(Preintegration, AnIntervalThatCannotBeWeightedSaysSo) {
  auto samples = wavingSamples(0.05, 200.0);
  samples[3].acceleration.x() = 1e200;
  const Preintegration imu = integrated(samples);
  EXPECT_FALSE(imu.isWeightable());
  EXPECT_TRUE(imu.sqrtInformation().isZero(0.0));
}

/// White noise and bias walk put on readings as the sensor model says.
std::vector<ImuSample> noisy(const std::vector<ImuSample>& clean, double rate, Random* random,
                             Vector3d* walked_acc, Vector3d* walked_gyr) {
  std::vector<ImuSample> samples = clean;
  walked_acc->setZero();
  walked_gyr->setZero();
  for (ImuSample& sample : samples) {
    sample.acceleration +=
        *walked_acc + kNoise.accelerometer_noise * std::sqrt(rate) * random->normal3();
    sample.angular_velocity +=
        *walked_gyr + kNoise.gyroscope_noise * std::sqrt(rate) * random->normal3();
    *walked_acc += kNoise.accelerometer_walk / std::sqrt(rate) * random->normal3();
    *walked_gyr += kNoise.gyroscope_walk / std::sqrt(rate) * random->normal3();
  }
  return samples;
}

TEST(Preintegration, CovarianceIsThatOfAThousandNoisyRuns) {
  constexpr double kRate = 200.0;
  constexpr int kRuns = 1000;
  const auto clean = wavingSamples(1.0, kRate);
  const Preintegration truth = integrated(clean);
  const Eigen::LLT<Matrix15d> covariance(truth.covariance());
  Random random(5);
  double squared_sum = 0.0;
  Matrix15d sample_covariance = Matrix15d::Zero();
  for (int run = 0; run < kRuns; ++run) {
    Vector15d e;
    Vector3d walked_acc, walked_gyr;
    const Preintegration imu = integrated(noisy(clean, kRate, &random, &walked_acc, &walked_gyr));
    // Errors are integrated minus true: a bias that has walked up is integrated with too little.
    e << errors(imu, truth), -walked_acc, -walked_gyr;
    squared_sum += e.dot(covariance.solve(e));
    sample_covariance += e * e.transpose() / kRuns;
  }
  // The mean of 1000 chi-square numbers of 15 degrees of freedom has a deviation of 0.173; the
  // bounds are four of them.
  EXPECT_NEAR(squared_sum / kRuns, 15.0, 0.7);
  // Each variance alone: four deviations of sqrt(2 / 1000).
  for (int i = 0; i < 15; ++i) {
    EXPECT_NEAR(sample_covariance(i, i) / truth.covariance()(i, i), 1.0, 0.18) << "component " << i;
  }
}

TEST(Preintegration, AGapIsUncertainButCanBeWeighted) {
  const ImuNoise noise{2.0e-3, 1.7e-4, 3.0e-3, 1.9e-5, 9.81};
  const auto samples = testing::wavingSamples(0.2, 200.0);
  Preintegration whole(noise, Vector3d::Zero(), Vector3d::Zero());
  whole.integrate(samples);
  Preintegration gap(noise, Vector3d::Zero(), Vector3d::Zero());
  gap.integrate({samples.front(), samples.back()});
  EXPECT_TRUE(gap.sqrtInformation().allFinite());
  const auto sigma = [](const Preintegration& imu, int row) {
    return std::sqrt(imu.covariance()(row, row));
  };
  // What was missed lies within the deviations that say so, which are far above the usual ones.
  const Vector3d missed = gap.beta() - whole.beta();
  EXPECT_LT(missed.norm(), 3.0 * sigma(gap, kVelocity));
  EXPECT_GT(sigma(gap, kVelocity), 20.0 * sigma(whole, kVelocity));
  EXPECT_GT(sigma(gap, kRotation), 20.0 * sigma(whole, kRotation));
}

}  // namespace
}  // namespace vins::estimator
