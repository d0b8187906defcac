#include "vins_pipeline/rig_summary.h"

#include <gtest/gtest.h>

namespace vins::pipeline {
namespace {

TEST(RigSummary, NamesWhatWasEstimatedOnly) {
  estimator::RigCalibration rig;
  rig.td = -0.0487;
  rig.readout = 0.024;
  estimator::RigMatrix covariance = estimator::RigMatrix::Zero();
  covariance(estimator::kTimeOffset, estimator::kTimeOffset) = 4e-8;
  EXPECT_EQ(describeRig(rig, covariance), "  time offset       -48.700 +- 0.200 ms\n");
  covariance(estimator::kReadout, estimator::kReadout) = 1e-6;
  EXPECT_NE(describeRig(rig, covariance).find("read-out          +24.000 +- 1.000 ms"),
            std::string::npos);
}

TEST(RigSummary, IsEmptyForARigThatIsTrusted) {
  EXPECT_EQ(describeRig({}, estimator::RigMatrix::Zero()), "");
  EXPECT_EQ(describeRig({}, 1e-18 * estimator::RigMatrix::Identity()), "");
}

}  // namespace
}  // namespace vins::pipeline
