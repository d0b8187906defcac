// The files that are handed out with the programs, and the tool that made one of them.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "pose_graph/place/brief.h"
#include "pose_graph/place/spread_corners.h"
#include "pose_graph/place/vocabulary_file.h"
#include "textured_image.h"

namespace fs = std::filesystem;

namespace vins::pose_graph {
namespace {

const char* const kPattern = "../support_files/brief_pattern.yml";
const char* const kVocabulary = "../support_files/brief_k10L5.voc";

std::string textOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

int runMakeBriefPattern(const std::string& arguments) {
  const fs::path tool = fs::read_symlink("/proc/self/exe").parent_path() / "make_brief_pattern";
  return WEXITSTATUS(std::system((tool.string() + " " + arguments + " > /dev/null 2>&1").c_str()));
}

TEST(SupportFiles, PatternIsWhatTheToolMakes) {
  const std::string path = ::testing::TempDir() + "support_files_test.yml";
  ASSERT_EQ(runMakeBriefPattern("-o " + path), 0);
  EXPECT_EQ(textOf(path), textOf(kPattern));
  EXPECT_EQ(BriefPattern::load(kPattern).radius(), 24);
  fs::remove(path);
}

TEST(SupportFiles, ToolSaysWhatIsWrong) {
  EXPECT_EQ(runMakeBriefPattern("--help"), 0);
  EXPECT_EQ(runMakeBriefPattern(""), 1);
  EXPECT_EQ(runMakeBriefPattern("-o /dev/null/pattern.yml"), 1);
  EXPECT_EQ(runMakeBriefPattern("-o /dev/null/pattern.yml --patch 3"), 1);
}

TEST(SupportFiles, VocabularyTellsImagesApart) {
  const Vocabulary vocabulary = readVocabulary(kVocabulary);
  EXPECT_EQ(vocabulary.branching(), 10);
  EXPECT_EQ(vocabulary.levels(), 5);
  EXPECT_LT(fs::file_size(kVocabulary), 6'000'000u);
  const BriefExtractor brief(BriefPattern::load(kPattern));
  const auto bagOf = [&](const cv::Mat& image) {
    const auto corners = findSpreadCorners(image, {}, {});
    return vocabulary.describe(brief.describe(image, corners).descriptors, 0).bag;
  };
  const cv::Mat1b image = testing::texturedImage(752, 480, 1);
  // Seen from three pixels aside: corners leave the image, and cells choose others.
  const cv::Mat aside = image(cv::Rect(3, 2, 749, 478));
  const double same = bagScore(bagOf(image), bagOf(aside));
  const double other = bagScore(bagOf(image), bagOf(testing::texturedImage(752, 480, 2)));
  EXPECT_GT(same, 3.0 * other) << same << " " << other;
}

}  // namespace
}  // namespace vins::pose_graph
