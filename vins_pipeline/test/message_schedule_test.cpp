#include "vins_pipeline/message_schedule.h"

#include <gtest/gtest.h>

namespace vins::pipeline {
namespace {

TEST(MessageSchedule, OrdersByTimeThenStreamThenIndex) {
  const auto messages = inOrderOfArrival({{10, 20, 20, 30}, {}, {20, 25}});
  ASSERT_EQ(messages.size(), 6u);
  const std::size_t streams[] = {0, 0, 0, 2, 2, 0}, indices[] = {0, 1, 2, 0, 1, 3};
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(messages[i].stream, streams[i]) << i;
    EXPECT_EQ(messages[i].index, indices[i]) << i;
  }
}

}  // namespace
}  // namespace vins::pipeline
