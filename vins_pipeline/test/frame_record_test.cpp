#include "vins_pipeline/frame_record.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "vins_core/so3.h"

namespace vins::pipeline {
namespace {

/// Numbers of a table's last line.
std::vector<double> lastRow(const std::string& csv) {
  std::istringstream in(csv);
  std::string line, last, field;
  while (std::getline(in, line)) last = line;
  std::vector<double> row;
  std::istringstream fields(last);
  while (std::getline(fields, field, ',')) row.push_back(std::stod(field));
  return row;
}

std::size_t linesOf(const std::string& csv) {
  return static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n'));
}

PipelineResult resultWith(const estimator::Odometry& odometry) {
  PipelineResult result;
  result.stamp = odometry.stamp;
  result.tracker.before = 90;
  result.tracker.tracked = 80;
  result.tracker.inliers = 70;
  result.tracker.detected = 30;
  result.tracker.mean_track_length = 12.5;
  estimator::EstimatorResult estimate;
  estimate.odometry = odometry;
  estimate.statistics.landmarks = 55;
  estimate.statistics.outliers = 2;
  estimate.statistics.keyframe = true;
  estimate.rig.td = -0.047;
  estimate.rig_covariance(6, 6) = 4e-6;
  result.estimates.push_back(estimate);
  return result;
}

TEST(FrameRecord, WritesALineForEachImageAndOdometry) {
  FrameRecord record;
  estimator::Odometry odometry;
  odometry.stamp = 1'600'000'000'000'000'000;
  odometry.sequence = 3;
  record.add(resultWith(odometry));
  PipelineResult waiting;
  waiting.stamp = odometry.stamp + 50'000'000;
  waiting.estimates.emplace_back();
  record.add(waiting);
  EXPECT_EQ(linesOf(record.trackerCsv()), 3u);
  EXPECT_EQ(linesOf(record.estimatorCsv()), 2u);
  EXPECT_NE(record.trackerCsv().find("\n1600000000000000000,90,80,70,30,12.500\n"),
            std::string::npos);
  const std::vector<double> row = lastRow(record.estimatorCsv());
  ASSERT_EQ(row.size(), 15u);
  EXPECT_EQ(std::vector<double>(row.begin() + 1, row.begin() + 5),
            (std::vector<double>{3.0, 55.0, 2.0, 1.0}));
}

TEST(FrameRecord, DeviationsAreThoseOfTheWorldsAxes) {
  estimator::Odometry odometry;
  // The body's x axis points up: what is uncertain about it is yaw.
  odometry.state.T_wb.rotation = Eigen::Quaterniond(so3::exp({0.0, -M_PI / 2.0, 0.0}));
  odometry.covariance.diagonal()[estimator::kPosition] = 0.04;
  odometry.covariance.diagonal()[estimator::kPosition + 2] = 0.09;
  odometry.covariance.diagonal()[estimator::kRotation] = 0.01;
  odometry.covariance.diagonal()[estimator::kVelocity + 1] = 0.25;
  FrameRecord record;
  record.add(resultWith(odometry));
  const std::vector<double> row = lastRow(record.estimatorCsv());
  ASSERT_EQ(row.size(), 15u);
  constexpr double kWritten = 1e-6;  // six digits are written
  EXPECT_NEAR(row[5], 0.2, kWritten);
  EXPECT_NEAR(row[6], 0.0, kWritten);
  EXPECT_NEAR(row[7], 0.3, kWritten);
  EXPECT_NEAR(row[8], 0.1 * 180.0 / M_PI, kWritten);
  EXPECT_NEAR(row[9], 0.0, kWritten);
  EXPECT_NEAR(row[11], 0.5, kWritten);
  EXPECT_NEAR(row[13], -0.047, kWritten);
  EXPECT_NEAR(row[14], 0.002, kWritten);
}

TEST(FrameRecord, RoundingBelowZeroIsNoDeviation) {
  estimator::Odometry odometry;
  odometry.covariance.diagonal()[estimator::kPosition] = -1e-18;
  FrameRecord record;
  record.add(resultWith(odometry));
  EXPECT_EQ(lastRow(record.estimatorCsv())[5], 0.0);
}

}  // namespace
}  // namespace vins::pipeline
