#include "vins_core/text_file.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "vins_core/input_error.h"

namespace vins {
namespace {

TEST(TextFile, ReplacesTheFileAndLeavesNothingAside) {
  const std::string path = ::testing::TempDir() + "text_file_test.txt";
  writeTextFile(path, "old and longer\n");
  writeTextFile(path, "new\n");
  std::ifstream in(path);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "new\n");
  EXPECT_FALSE(std::ifstream(path + ".part").good());
  std::remove(path.c_str());
}

TEST(TextFile, NamesTheFileThatCannotBeWritten) {
  try {
    writeTextFile("/dev/null/all.txt", "text");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "/dev/null: cannot be made: Not a directory");
  }
}

}  // namespace
}  // namespace vins
