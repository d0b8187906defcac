#include "vins_pipeline/stamp_order.h"

#include <vector>

#include <gtest/gtest.h>

namespace vins::pipeline {
namespace {

using Stream = StampOrder::Stream;
using Places = std::vector<std::size_t>;

constexpr Stamp kSecond = 1'000'000'000;

TEST(StampOrder, SortsByStampAndKeepsTheOrderOfEqualOnes) {
  StampOrder order;
  for (const Stamp stamp : {10, 20, 30}) order.add(Stream::kImu, stamp);
  for (const Stamp stamp : {20, 10, 25}) order.add(Stream::kImage, stamp);
  order.sort();
  EXPECT_EQ(order.place(), (Places{0, 4, 1, 3, 5, 2}));
}

TEST(StampOrder, KeepsTheArrivalWhereClocksAreApart) {
  StampOrder order;
  order.add(Stream::kImu, 3600 * kSecond);
  order.add(Stream::kImage, 5);
  order.add(Stream::kImu, 3601 * kSecond);
  order.add(Stream::kImage, 6);
  order.sort();
  EXPECT_EQ(order.place(), (Places{0, 1, 2, 3}));
}

TEST(StampOrder, KeepsTheArrivalOfSeveralRuns) {
  StampOrder order;
  for (int run = 0; run < 2; ++run) {
    order.add(Stream::kImu, 10 * kSecond);
    order.add(Stream::kImage, 10 * kSecond);
    order.add(Stream::kImu, 12 * kSecond);
  }
  order.sort();
  EXPECT_EQ(order.place(), (Places{0, 1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace vins::pipeline
