#include "vins_core/folder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "vins_core/input_error.h"
#include "vins_core/text_file.h"

namespace fs = std::filesystem;

namespace vins {
namespace {

class Folder : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  const fs::path folder_ =
      fs::path(::testing::TempDir()) / ("folder_test_" + std::to_string(getpid()));
};

TEST_F(Folder, IsMadeWithThoseAboveIt) {
  makeFolder(path("a/b/c"));
  EXPECT_TRUE(fs::is_directory(path("a/b/c")));
  EXPECT_NO_THROW(makeFolder(path("a/b/c"))) << "which is there already";
  EXPECT_NO_THROW(makeFolder(path("d/")));
  EXPECT_TRUE(fs::is_directory(path("d")));
}

TEST_F(Folder, OfAFileIsMade) {
  makeFolderOf(path("x/y/file.txt"));
  EXPECT_TRUE(fs::is_directory(path("x/y")));
  EXPECT_FALSE(fs::exists(path("x/y/file.txt")));
  EXPECT_NO_THROW(makeFolderOf("file_beside.txt"));
}

TEST_F(Folder, WhereAFileIsInTheWayIsAnError) {
  std::ofstream(path("file")) << "x";
  for (const std::string name : {"file", "file/below"}) {
    try {
      makeFolder(path(name));
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(path(name) + ": cannot be made: "),
                std::string::npos)
          << error.what();
    }
  }
}

TEST_F(Folder, OfATextFileIsMadeWhenItIsWritten) {
  writeTextFile(path("new/text.txt"), "text\n");
  EXPECT_TRUE(fs::is_regular_file(path("new/text.txt")));
}

TEST(PathSeenFrom, TheFileThatNamesIt) {
  EXPECT_EQ(pathSeenFrom("/rigs/euroc.yaml", "mask.png"), "/rigs/mask.png");
  EXPECT_EQ(pathSeenFrom("rigs/euroc.yaml", "maps/hall"), "rigs/maps/hall");
  EXPECT_EQ(pathSeenFrom("euroc.yaml", "maps"), "maps");
  EXPECT_EQ(pathSeenFrom("/rigs/euroc.yaml", "/maps"), "/maps");
  EXPECT_EQ(pathSeenFrom("/rigs/euroc.yaml", ""), "");
  ASSERT_EQ(setenv("HOME", "/home/me", 1), 0);
  EXPECT_EQ(pathSeenFrom("/rigs/euroc.yaml", "~/maps"), "/home/me/maps");
  EXPECT_EQ(pathSeenFrom("/rigs/euroc.yaml", "~maps"), "/rigs/~maps");
}

}  // namespace
}  // namespace vins
