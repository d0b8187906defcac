#include "vins_pipeline/rig_summary.h"

#include <cmath>
#include <cstdio>
#include <vector>

namespace vins::pipeline {
namespace {

using estimator::RigVector;

/// Values of neighbouring errors and how they are printed.
struct Quantity {
  const char* name;
  std::vector<int> at;  ///< in the vector of all errors
  double factor;        ///< to the unit that is printed
  const char* unit;
};

std::vector<Quantity> quantities() {
  using estimator::kImuIntrinsics;
  using estimator::kIntrinsics;
  const int gyro = kImuIntrinsics + estimator::kAccelerometerIntrinsics;
  return {{"camera position", {0, 1, 2}, 1e3, "mm"},
          {"camera rotation", {3, 4, 5}, 180.0 / M_PI, "deg"},
          {"time offset", {estimator::kTimeOffset}, 1e3, "ms"},
          {"read-out", {estimator::kReadout}, 1e3, "ms"},
          {"focal lengths", {kIntrinsics, kIntrinsics + 1}, 100.0, "%"},
          {"principal point", {kIntrinsics + 2, kIntrinsics + 3}, 100.0, "% of the focal length"},
          {"distortion", {kIntrinsics + 4, kIntrinsics + 5}, 1.0, "(k1, k2)"},
          {"accelerometer", {kImuIntrinsics, kImuIntrinsics + 2, kImuIntrinsics + 5}, 100.0, "%"},
          {"gyroscope", {gyro, gyro + 4, gyro + 8}, 100.0, "%"}};
}

std::string printed(const Quantity& quantity, const RigVector& value, const RigVector& sigma) {
  std::string line;
  for (const int i : quantity.at) {
    char text[64];
    std::snprintf(text, sizeof(text), "%s%+.3f +- %.3f", line.empty() ? "" : ", ",
                  quantity.factor * value(i), quantity.factor * sigma(i));
    line += text;
  }
  return line + " " + quantity.unit;
}

}  // namespace

std::string describeRig(const estimator::RigCalibration& rig,
                        const estimator::RigMatrix& covariance) {
  constexpr double kLeastSigma = 1e-8;  // what is trusted has less
  const RigVector value = minus(rig, estimator::RigCalibration());
  const RigVector sigma = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  std::string text;
  for (const Quantity& quantity : quantities()) {
    if (!(sigma(quantity.at.front()) > kLeastSigma)) continue;
    char name[32];
    std::snprintf(name, sizeof(name), "  %-18s", quantity.name);
    text += name + printed(quantity, value, sigma) + "\n";
  }
  return text;
}

}  // namespace vins::pipeline
