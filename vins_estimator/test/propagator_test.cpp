#include "vins_estimator/inertial/propagator.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"
#include "vins_core/so3.h"
#include "vins_core/testing/numeric_jacobian.h"

namespace vins::estimator {
namespace {

using Eigen::Vector3d;

const Vector3d kAccBias(0.1, -0.2, 0.05);
const Vector3d kGyrBias(0.01, 0.02, -0.03);

NavState trueState(double t) {
  NavState state;
  state.T_wb.rotation = so3::exp({0.0, 0.0, 0.5 * t}) * so3::exp({0.3 * std::sin(t), 0.1, 0.0});
  state.T_wb.position = {std::cos(t), std::sin(t), 0.5 * std::sin(2.0 * t)};
  state.v_w = {-std::sin(t), std::cos(t), std::cos(2.0 * t)};
  state.accelerometer_bias = kAccBias;
  state.gyroscope_bias = kGyrBias;
  return state;
}

ImuSample trueSample(double t) {
  const Vector3d a_w(-std::cos(t), -std::sin(t), -2.0 * std::sin(2.0 * t));
  const Eigen::Quaterniond R = trueState(t).T_wb.rotation;
  const double h = 1e-4;
  const Vector3d omega =
      so3::log(trueState(t - h).T_wb.rotation.conjugate() * trueState(t + h).T_wb.rotation) /
      (2.0 * h);
  return {toNanoseconds(t), R.conjugate() * (a_w + Vector3d(0, 0, 9.81)) + kAccBias,
          omega + kGyrBias};
}

ImuNoise noise() { return {2e-3, 1.7e-4, 3e-3, 2e-5, 9.81}; }

double positionError(const PropagatedState& state) {
  return (state.state.T_wb.position - trueState(toSeconds(state.stamp)).T_wb.position).norm();
}

TEST(Propagator, FollowsTheMotion) {
  Propagator propagator(noise());
  propagator.setState(0, trueState(0.0), Matrix15d::Zero());
  std::optional<PropagatedState> state;
  for (int i = 0; i <= 400; ++i) {
    state = propagator.addImu(trueSample(0.005 * i));
    ASSERT_TRUE(state);
    EXPECT_EQ(state->stamp, toNanoseconds(0.005 * i));
  }
  const NavState truth = trueState(2.0);
  // The midpoint rule's error over 2 s of this motion.
  EXPECT_LT(positionError(*state), 2e-4);
  EXPECT_LT((state->state.v_w - truth.v_w).norm(), 2e-4);
  EXPECT_LT(so3::log(truth.T_wb.rotation.conjugate() * state->state.T_wb.rotation).norm(), 1e-5);
  EXPECT_LT((state->angular_velocity_b - (trueSample(2.0).angular_velocity - kGyrBias)).norm(),
            1e-12);
  EXPECT_NEAR(state->horizon, 2.0, 1e-9);
}

TEST(Propagator, ANewStateIsCarriedOverTheSamplesThatWaited) {
  Propagator late(noise()), prompt(noise());
  prompt.setState(toNanoseconds(0.5), trueState(0.5), Matrix15d::Identity());
  for (int i = 0; i <= 200; ++i) {
    const auto nothing = late.addImu(trueSample(0.005 * i));
    EXPECT_FALSE(nothing);
    if (i >= 100) prompt.addImu(trueSample(0.005 * i));
  }
  late.setState(toNanoseconds(0.5), trueState(0.5), Matrix15d::Identity());
  const auto a = late.addImu(trueSample(1.005)), b = prompt.addImu(trueSample(1.005));
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->state.T_wb.position, b->state.T_wb.position);
  EXPECT_EQ(a->state.T_wb.rotation.coeffs(), b->state.T_wb.rotation.coeffs());
  EXPECT_EQ(a->covariance, b->covariance);
  EXPECT_EQ(a->angular_velocity_b, b->angular_velocity_b);
}

TEST(Propagator, AStateBetweenTwoSamplesIsCarriedFromWhereItIs) {
  Propagator propagator(noise());
  for (int i = 0; i <= 100; ++i) propagator.addImu(trueSample(0.005 * i));
  propagator.setState(toNanoseconds(0.4023), trueState(0.4023), Matrix15d::Zero());
  const auto state = propagator.addImu(trueSample(0.505));
  ASSERT_TRUE(state);
  EXPECT_LT(positionError(*state), 2e-5);
  EXPECT_NEAR(state->horizon, 0.1027, 1e-9);
}

TEST(Propagator, TheCovarianceFollowsTheErrors) {
  // Linearized: what a small error of the first state has become half a second later.
  const auto errorAfter = [](const Eigen::VectorXd& d) -> Eigen::VectorXd {
    Propagator moved(noise()), reference(noise());
    moved.setState(0, plus(trueState(0.0), d), Matrix15d::Zero());
    reference.setState(0, trueState(0.0), Matrix15d::Zero());
    std::optional<PropagatedState> a, b;
    for (int i = 0; i <= 100; ++i) {
      a = moved.addImu(trueSample(0.005 * i));
      b = reference.addImu(trueSample(0.005 * i));
    }
    return minus(a->state, b->state);
  };
  const Eigen::MatrixXd J = vins::testing::numericJacobian(errorAfter, 15);
  ImuNoise quiet{1e-12, 1e-12, 1e-12, 1e-12, 9.81};
  Propagator propagator(quiet);
  Matrix15d initial = Matrix15d::Zero();
  for (int i = 0; i < 15; ++i) initial(i, i) = 0.1 + 0.05 * i;
  propagator.setState(0, trueState(0.0), initial);
  std::optional<PropagatedState> state;
  for (int i = 0; i <= 100; ++i) state = propagator.addImu(trueSample(0.005 * i));
  const Eigen::MatrixXd expected = J * initial * J.transpose();
  // The transition is exact to first order in the sample period.
  EXPECT_LT((state->covariance - expected).norm(), 2e-3 * expected.norm());
}

TEST(Propagator, TheCovarianceIsThatOfManyNoisyRuns) {
  constexpr int kRuns = 500, kSamples = 100;
  constexpr double kPeriod = 0.005;
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal;
  const auto random3 = [&] { return Vector3d(normal(engine), normal(engine), normal(engine)); };
  const ImuNoise n = noise();
  Propagator reference(n);
  reference.setState(0, trueState(0.0), Matrix15d::Zero());
  std::vector<ImuSample> samples;
  std::optional<PropagatedState> expected;
  for (int i = 0; i <= kSamples; ++i) {
    samples.push_back(trueSample(kPeriod * i));
    expected = reference.addImu(samples.back());
  }
  const auto inverse = expected->covariance.block<9, 9>(0, 0).inverse().eval();
  double sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Propagator propagator(n);
    propagator.setState(0, trueState(0.0), Matrix15d::Zero());
    Vector3d walk_a(0, 0, 0), walk_g(0, 0, 0);
    std::optional<PropagatedState> state;
    for (ImuSample sample : samples) {
      sample.acceleration += walk_a + n.accelerometer_noise / std::sqrt(kPeriod) * random3();
      sample.angular_velocity += walk_g + n.gyroscope_noise / std::sqrt(kPeriod) * random3();
      walk_a += n.accelerometer_walk * std::sqrt(kPeriod) * random3();
      walk_g += n.gyroscope_walk * std::sqrt(kPeriod) * random3();
      state = propagator.addImu(sample);
    }
    const Eigen::Matrix<double, 9, 1> e = minus(state->state, expected->state).head<9>();
    sum += e.dot(inverse * e) / 9.0;
  }
  // Deviation of the mean: sqrt(2 / (9 * 500)) = 0.021. Neighbouring steps share a sample, which
  // the covariance does not know: 1 % in variance over this interval.
  EXPECT_NEAR(sum / kRuns, 1.0, 0.08);
}

TEST(Propagator, TheNoiseOfAStepActsOnThePositionAndWithTheVelocity) {
  constexpr double kStep = 0.1;  // [s]: long, so that one step shows it
  const ImuNoise n = noise();
  Propagator propagator(n);
  propagator.setState(0, trueState(0.0), Matrix15d::Zero());
  propagator.addImu(trueSample(0.0));
  const auto state = propagator.addImu(trueSample(kStep));
  ASSERT_TRUE(state);
  // An error a of the mean acceleration has the variance s^2 / dt, and makes a dt of velocity and
  // a dt^2 / 2 of position. The gyroscope's noise adds less than 0.01 % here.
  const double variance = n.accelerometer_noise * n.accelerometer_noise / kStep;
  const auto P = [&](int i, int j) { return state->covariance(i, j); };
  for (int i = 0; i < 3; ++i) {
    const double expected = variance * std::pow(0.5 * kStep * kStep, 2);
    EXPECT_NEAR(P(kPosition + i, kPosition + i), expected, 0.01 * expected) << i;
    const double correlation =
        P(kPosition + i, kVelocity + i) /
        std::sqrt(P(kPosition + i, kPosition + i) * P(kVelocity + i, kVelocity + i));
    EXPECT_NEAR(correlation, 1.0, 1e-3) << i;
  }
}

TEST(Propagator, TheRateHasTheNoiseOfOneReading) {
  Propagator propagator(noise());
  propagator.setState(0, trueState(0.0), Matrix15d::Zero());
  std::optional<PropagatedState> state;
  for (int i = 0; i <= 40; ++i) state = propagator.addImu(trueSample(0.005 * i));
  ASSERT_TRUE(state);
  const double expected = noise().gyroscope_noise * noise().gyroscope_noise * 200.0;
  EXPECT_NEAR(state->angular_velocity_variance, expected, 1e-6 * expected);
}

TEST(Propagator, IgnoresWhatItCannotUse) {
  Propagator propagator(noise());
  EXPECT_FALSE(propagator.addImu(trueSample(0.0)));
  NavState bad = trueState(0.0);
  bad.v_w.x() = std::numeric_limits<double>::quiet_NaN();
  propagator.setState(0, bad, Matrix15d::Zero());
  EXPECT_FALSE(propagator.addImu(trueSample(0.005)));
  propagator.setState(0, trueState(0.0), Matrix15d::Zero());
  EXPECT_TRUE(propagator.addImu(trueSample(0.01)));
  EXPECT_FALSE(propagator.addImu(trueSample(0.01)));
  EXPECT_FALSE(propagator.addImu(trueSample(0.007)));
  ImuSample nan = trueSample(0.015);
  nan.angular_velocity.z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(propagator.addImu(nan));
  EXPECT_TRUE(propagator.addImu(trueSample(0.02)));
  propagator.reset();
  EXPECT_EQ(propagator.sampleCount(), 0u);
  EXPECT_FALSE(propagator.addImu(trueSample(0.025)));
}

TEST(Propagator, EndsAtItsHorizonAndKeepsABoundedBuffer) {
  PropagatorOptions options;
  options.max_horizon = 1.0;
  Propagator propagator(noise(), options);
  propagator.setState(0, trueState(0.0), Matrix15d::Zero());
  int given = 0;
  for (int i = 0; i <= 2000; ++i) given += propagator.addImu(trueSample(0.005 * i)) ? 1 : 0;
  EXPECT_EQ(given, 201);
  EXPECT_LE(propagator.sampleCount(), 203u);
  propagator.setState(toNanoseconds(9.9), trueState(9.9), Matrix15d::Zero());
  EXPECT_TRUE(propagator.addImu(trueSample(10.005)));
  options.max_horizon = 0.0;
  EXPECT_THROW(Propagator(noise(), options), InputError);
}

TEST(Propagator, ASampleTakesMicroseconds) {
  Propagator propagator(noise());
  propagator.setState(0, trueState(0.0), Matrix15d::Identity());
  std::vector<ImuSample> samples;
  for (int i = 0; i < 1000; ++i) samples.push_back(trueSample(0.005 * i));
  const auto start = std::chrono::steady_clock::now();
  for (const ImuSample& sample : samples) propagator.addImu(sample);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  // Room for a busy machine and a build without optimization.
  EXPECT_LT(elapsed.count() / 1000.0, 200e-6);
  RecordProperty("nanoseconds", static_cast<int>(1e6 * elapsed.count()));
}

}  // namespace
}  // namespace vins::estimator
