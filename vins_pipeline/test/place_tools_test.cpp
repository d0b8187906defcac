// train_vocabulary and evaluate_places, run as a user runs them.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sys/wait.h>

#include "pose_graph/place/vocabulary_file.h"
#include "vins_core/testing/shared_data.h"

namespace fs = std::filesystem;

namespace vins::pipeline {
namespace {

const char* const kPattern = " --pattern ../support_files/brief_pattern.yml ";

struct Outcome {
  int exit_code = 0;
  std::string output;
};

std::string textOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class PlaceTools : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "images");
    for (int i = 0; i < 6; ++i) {
      cv::Mat1b image(300, 400, 120);
      cv::RNG random(static_cast<std::uint64_t>(i) + 1);
      for (int j = 0; j < 1000; ++j) {
        const cv::Rect block(random.uniform(0, 400), random.uniform(0, 300), 12, 9);
        cv::rectangle(image, block, random.uniform(0, 256), cv::FILLED);
      }
      cv::imwrite((folder_ / "images" / (std::to_string(i) + ".png")).string(), image);
    }
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  Outcome run(const std::string& tool, const std::string& arguments) const {
    const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / tool;
    const std::string log = path("log.txt");
    const int status =
        std::system((program.string() + " " + arguments + " > " + log + " 2>&1").c_str());
    return {WEXITSTATUS(status), textOf(log)};
  }

  const fs::path folder_ = fs::path(::testing::TempDir()) / "place_tools_test";
};

TEST_F(PlaceTools, TrainsTheSameVocabularyAgain) {
  const std::string input = path("images") + kPattern + "--k 5 --levels 3 -o ";
  const Outcome first = run("train_vocabulary", input + path("a.voc"));
  ASSERT_EQ(first.exit_code, 0) << first.output;
  EXPECT_NE(first.output.find("6 images"), std::string::npos) << first.output;
  ASSERT_EQ(run("train_vocabulary", input + path("b.voc")).exit_code, 0);
  ASSERT_EQ(run("train_vocabulary", input + path("c.voc") + " --seed 2").exit_code, 0);
  const pose_graph::Vocabulary vocabulary = pose_graph::readVocabulary(path("a.voc"));
  EXPECT_EQ(vocabulary.branching(), 5);
  EXPECT_GT(vocabulary.wordCount(), 100u);
  EXPECT_EQ(textOf(path("a.voc")), textOf(path("b.voc")));
  EXPECT_NE(textOf(path("a.voc")), textOf(path("c.voc")));
}

TEST_F(PlaceTools, TrainsOnFewerDescriptorsWhereAsked) {
  const std::string input = path("images") + kPattern + "--max-descriptors 300 -o " + path("a.voc");
  ASSERT_EQ(run("train_vocabulary", input + " --fewest-to-split 2").exit_code, 0);
  EXPECT_LE(pose_graph::readVocabulary(path("a.voc")).wordCount(), 300u);
}

TEST_F(PlaceTools, TrainsOnRecordings) {
  const std::string recording = vins::testing::sharedData("euroc_v101_micro");
  VINS_SKIP_WITHOUT(recording);
  const Outcome outcome = run("train_vocabulary", recording + " " + path("images") + "/0.png" +
                                                      kPattern + "--every 1 -o " + path("a.voc"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("0.png: 1 images"), std::string::npos) << outcome.output;
}

TEST_F(PlaceTools, TrainWithoutAnImageThatCannotBeRead) {
  const std::string input = path("images") + kPattern + "--k 5 --levels 3 -o ";
  std::ofstream(path("images/bad.png")) << "no image";
  const Outcome outcome = run("train_vocabulary", input + path("a.voc"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("refused: 1 of 7 images"), std::string::npos) << outcome.output;
  EXPECT_NE(outcome.output.find("bad.png: is no image that can be read"), std::string::npos);
  fs::remove(path("images/bad.png"));
  ASSERT_EQ(run("train_vocabulary", input + path("b.voc")).exit_code, 0);
  EXPECT_EQ(textOf(path("a.voc")), textOf(path("b.voc")));
  std::ofstream(path("alone.png")) << "no image";
  EXPECT_EQ(run("train_vocabulary", path("alone.png") + kPattern + "-o " + path("c.voc")).exit_code,
            1);
}

TEST_F(PlaceTools, EvaluateWithoutAnImageThatCannotBeRead) {
  const std::string recording = vins::testing::sharedData("euroc_v101_micro");
  VINS_SKIP_WITHOUT(recording);
  const fs::path copy = folder_ / "copy";
  fs::copy(recording, copy, fs::copy_options::recursive);
  fs::path last;
  for (const auto& entry : fs::recursive_directory_iterator(copy)) {
    if (entry.path().extension() != ".png") continue;
    if (entry.path().string().find("cam0") != std::string::npos)
      last = std::max(last, entry.path());
  }
  fs::remove(last);
  std::ofstream(last) << "no image";
  const Outcome outcome =
      run("evaluate_places",
          "--config ../config/euroc/euroc_config.yaml --recording " + copy.string() + kPattern +
              "--vocabulary ../support_files/brief_k10L5.voc --out " + path("places"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("refused: 1 of "), std::string::npos) << outcome.output;
}

TEST_F(PlaceTools, SayWhatIsWrong) {
  const std::string out = " -o " + path("a.voc");
  for (const std::string& arguments :
       {std::string(), path("images") + out, path("missing") + kPattern + out,
        path("images/0.png") + kPattern + out, path("images") + kPattern + "--k 1" + out,
        path("images") + kPattern + "-o /dev/null/a.voc"}) {
    const Outcome outcome = run("train_vocabulary", arguments);
    EXPECT_EQ(outcome.exit_code, 1) << arguments;
    EXPECT_NE(outcome.output.find("train_vocabulary: "), std::string::npos) << outcome.output;
  }
  EXPECT_FALSE(fs::exists(path("a.voc")));
  EXPECT_EQ(run("train_vocabulary", "--help").exit_code, 0);
  EXPECT_EQ(run("evaluate_places", "--help").exit_code, 0);
  EXPECT_EQ(run("evaluate_places", "").exit_code, 1);
}

TEST_F(PlaceTools, EvaluateARecording) {
  const std::string recording = vins::testing::sharedData("euroc_v101_micro");
  VINS_SKIP_WITHOUT(recording);
  const Outcome outcome =
      run("evaluate_places", "--config ../config/euroc/euroc_config.yaml --recording " + recording +
                                 kPattern +
                                 "--vocabulary ../support_files/brief_k10L5.voc "
                                 "--exclude-keyframes 1 --exclude-seconds 0.3 --out " +
                                 path("places"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_NE(outcome.output.find("recall without a wrong answer"), std::string::npos);
  EXPECT_NE(textOf(path("places/brief_k10L5_curve.csv")).find("precision"), std::string::npos);
  EXPECT_NE(textOf(path("places/brief_k10L5_loops.csv")).find("status"), std::string::npos);
}

}  // namespace
}  // namespace vins::pipeline
