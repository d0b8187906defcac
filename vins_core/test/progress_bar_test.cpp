#include "vins_core/progress_bar.h"

#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>

namespace vins {
namespace {

TEST(ProgressBar, PrintsALineForEveryTenthWhereThereIsNoTerminal) {
  std::ostringstream out;
  ProgressBar bar(out, false, "work", 1000);
  for (std::size_t i = 1; i <= 1000; ++i) bar.update(i);
  bar.finish();
  const std::string text = out.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 10);
  EXPECT_NE(text.find("work [############............]  50 %"), std::string::npos) << text;
  EXPECT_NE(text.find("100 %"), std::string::npos);
}

TEST(ProgressBar, RedrawsOneLineOnATerminal) {
  std::ostringstream out;
  ProgressBar bar(out, true, "work", 3);
  bar.update(1, "a rather long note");
  bar.finish("short");
  const std::string text = out.str();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_EQ(text.front(), '\r');
  // The longer line before is blotted out.
  const std::size_t last = text.rfind('\r');
  EXPECT_GE(text.size() - last - 2, last - 1);
}

TEST(ProgressBar, NothingToDoIsDone) {
  std::ostringstream out;
  ProgressBar bar(out, false, "work", 0);
  bar.finish();
  EXPECT_NE(out.str().find("100 %"), std::string::npos);
}

}  // namespace
}  // namespace vins
