#include "vins_pipeline/run_record.h"

#include <cmath>

#include <gtest/gtest.h>

#include "vins_core/parameters.h"

namespace vins::pipeline {
namespace {

RunRecord makeRecord() {
  RunRecord record;
  for (int i = 100; i >= 1; --i) record.addDuration("tracker", {1e-3 * i, 2e-3 * i});
  record.addDuration("estimator", {0.5, 0.0});
  return record;
}

TEST(RunRecord, SummarizesAStage) {
  const StageSummary summary = makeRecord().summaryOf("tracker");
  EXPECT_EQ(summary.count, 100u);
  EXPECT_NEAR(summary.mean_ms, 50.5, 1e-9);
  EXPECT_NEAR(summary.median_ms, 50.0, 1e-9);
  EXPECT_NEAR(summary.p95_ms, 95.0, 1e-9);
  EXPECT_NEAR(summary.max_ms, 100.0, 1e-9);
  EXPECT_NEAR(summary.cpu_seconds, 2e-3 * 5050, 1e-9);
  EXPECT_EQ(makeRecord().summaryOf("unknown").count, 0u);
}

TEST(RunRecord, OneDurationIsItsOwnQuantiles) {
  const StageSummary summary = makeRecord().summaryOf("estimator");
  EXPECT_EQ(summary.count, 1u);
  EXPECT_EQ(summary.median_ms, 500.0);
  EXPECT_EQ(summary.p95_ms, 500.0);
}

TEST(RunRecord, JsonHoldsStagesAndTotals) {
  // JSON is YAML.
  const Parameters json = Parameters::parse(makeRecord().timingJson(12.5), "timing.json");
  EXPECT_EQ(json.section("stages").section("tracker").integer("count"), 100);
  EXPECT_NEAR(json.section("stages").section("tracker").number("p95_ms"), 95.0, 1e-3);
  EXPECT_EQ(json.section("stages").keys().front(), "tracker") << "in the order of their coming";
  EXPECT_EQ(json.number("data_seconds"), 12.5);
  EXPECT_GT(json.number("real_time_factor"), 1.0);
  EXPECT_GT(json.number("peak_memory_mb"), 1.0);
  EXPECT_GE(json.number("cpu_seconds"), 0.0);
}

TEST(RunRecord, JsonWithoutStagesIsValid) {
  const Parameters json = Parameters::parse(RunRecord().timingJson(0.0), "timing.json");
  EXPECT_EQ(json.section("stages").keys().size(), 0u);
}

TEST(RunRecord, EventsAreWrittenWithQuotes) {
  RunRecord record;
  record.addEvents({{1600000000000000001,
                     Severity::kWarning,
                     "imu_gap",
                     "no \"samples\", for long",
                     {{"gap_s", 0.25}, {"period_s", 0.005}}}});
  EXPECT_EQ(record.eventsCsv(),
            "#stamp [ns],severity,code,text,figures\n"
            "1600000000000000001,warning,imu_gap,\"no \"\"samples\"\", for long\","
            "gap_s=0.25 period_s=0.005\n");
}

TEST(RunRecord, TheTableHasALineForEachStage) {
  const std::string table = makeRecord().timingTable();
  EXPECT_NE(table.find("tracker        100     50.50"), std::string::npos) << table;
  EXPECT_NE(table.find("estimator        1    500.00"), std::string::npos) << table;
}

TEST(StopWatch, CpuTimeGrowsWithWork) {
  const StopWatch watch;
  double sum = 0.0;
  while (watch.elapsed().wall < 0.02) sum += std::sqrt(sum + 1.0);
  EXPECT_GT(watch.elapsed().cpu, 0.0);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace vins::pipeline
