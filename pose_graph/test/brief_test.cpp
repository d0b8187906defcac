#include "pose_graph/place/brief.h"

#include <cstdio>
#include <fstream>

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include "textured_image.h"
#include "vins_core/input_error.h"
#include "vins_core/text_file.h"

namespace vins::pose_graph {
namespace {

using testing::texturedImage;

bool areEqual(const BriefPattern& a, const BriefPattern& b) {
  for (std::size_t i = 0; i < a.pairs().size(); ++i) {
    if (a.pairs()[i].first != b.pairs()[i].first) return false;
    if (a.pairs()[i].second != b.pairs()[i].second) return false;
  }
  return true;
}

class BriefPatternFile : public ::testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }

  std::string messageOf(const std::string& text) const {
    writeTextFile(path_, text);
    try {
      BriefPattern::load(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const std::string path_ = ::testing::TempDir() + "brief_test_pattern.yml";
};

TEST(BriefPattern, IsTheSameForTheSameSeed) {
  const BriefPattern a = BriefPattern::generate(1, 49);
  EXPECT_TRUE(areEqual(a, BriefPattern::generate(1, 49)));
  EXPECT_FALSE(areEqual(a, BriefPattern::generate(2, 49)));
  EXPECT_LE(a.radius(), 24);
  EXPECT_THROW(BriefPattern::generate(1, 4), InputError);
}

TEST(BriefPattern, IsAGaussianAboutTheCorner) {
  const BriefPattern pattern = BriefPattern::generate(1, 49);
  double sum = 0.0, squares = 0.0;
  for (const auto& pair : pattern.pairs()) {
    EXPECT_NE(pair.first, pair.second);
    for (const int value : {pair.first.x, pair.first.y, pair.second.x, pair.second.y}) {
      sum += value, squares += value * value;
    }
  }
  const double count = 4.0 * kDescriptorBits;
  // The mean of 1024 values of deviation 9.8 has a deviation of 0.3, their deviation one of 0.2;
  // the patch's edge cuts it down by 0.4. Four deviations are allowed.
  EXPECT_NEAR(sum / count, 0.0, 1.2);
  EXPECT_NEAR(std::sqrt(squares / count), 49 / 5.0 - 0.4, 0.9);
}

TEST_F(BriefPatternFile, IsReadAsItWasWritten) {
  const BriefPattern pattern = BriefPattern::generate(3, 49);
  writeTextFile(path_, pattern.toYaml());
  EXPECT_TRUE(areEqual(pattern, BriefPattern::load(path_)));
  cv::FileStorage file(path_, cv::FileStorage::READ);
  std::vector<int> x1;
  file["x1"] >> x1;
  EXPECT_EQ(x1.size(), 256u) << "OpenCV reads it, too";
}

TEST_F(BriefPatternFile, InOpenCvsOwnLayoutIsRead) {
  const BriefPattern pattern = BriefPattern::generate(4, 49);
  std::vector<int> lists[4];
  for (const auto& pair : pattern.pairs()) {
    lists[0].push_back(pair.first.x), lists[1].push_back(pair.first.y);
    lists[2].push_back(pair.second.x), lists[3].push_back(pair.second.y);
  }
  {
    cv::FileStorage file(path_, cv::FileStorage::WRITE);
    file << "x1" << lists[0] << "y1" << lists[1] << "x2" << lists[2] << "y2" << lists[3];
  }
  EXPECT_TRUE(areEqual(pattern, BriefPattern::load(path_)));
}

TEST_F(BriefPatternFile, BadOnesAreNamed) {
  EXPECT_THROW(BriefPattern::load("/nowhere/pattern.yml"), InputError);
  std::string text = BriefPattern::generate(1, 49).toYaml();
  EXPECT_EQ(messageOf(text), "");
  EXPECT_NE(messageOf("%YAML:1.0\n---\nx1: [ 1, 2 ]\n").find("x1"), std::string::npos);
  const std::size_t y2 = text.find("y2: [ ");
  const std::string large =
      text.substr(0, y2) + "y2: [ 1000," + text.substr(text.find(',', y2) + 1);
  EXPECT_NE(messageOf(large).find("'y2': found 1000"), std::string::npos) << messageOf(large);
  EXPECT_NE(messageOf(text.substr(0, y2)).find("y2"), std::string::npos);
}

TEST(Brief, ComparesTheSmoothedImage) {
  // Brighter to the right: a bit is set where the second end lies farther right.
  cv::Mat1b ramp(100, 200);
  for (int x = 0; x < ramp.cols; ++x) ramp.col(x) = x;
  const BriefPattern pattern = BriefPattern::generate(1, 49);
  const auto described = BriefExtractor(pattern).describe(ramp, {{100, 50}});
  ASSERT_EQ(described.descriptors.size(), 1u);
  for (std::size_t bit = 0; bit < pattern.pairs().size(); ++bit) {
    const auto& pair = pattern.pairs()[bit];
    EXPECT_EQ((described.descriptors[0][bit / 64] >> (bit % 64)) & 1U,
              pair.first.x < pair.second.x ? 1U : 0U);
  }
}

TEST(Brief, SurvivesLightAndNoiseAndTellsPlacesApart) {
  const cv::Mat1b image = texturedImage(752, 480, 1);
  cv::Mat other;
  image.convertTo(other, CV_16S, 0.7, 20);
  cv::Mat noise(image.size(), CV_16S);
  cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0, 5);
  cv::Mat(other + noise).convertTo(other, CV_8U);
  std::vector<cv::Point2f> pixels;
  for (int i = 0; i < 100; ++i) pixels.emplace_back(40 + 6.5F * i, 40 + 4.0F * i);
  const BriefExtractor brief(BriefPattern::generate(1, 49));
  const auto a = brief.describe(image, pixels).descriptors,
             b = brief.describe(other, pixels).descriptors;
  ASSERT_EQ(a.size(), pixels.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    // Noise of 5 grey values is smoothed to 0.9: of blots that differ by tens of grey values few
    // comparisons turn. Between places half of the bits differ, with a deviation of some 10 to 20.
    EXPECT_LT(hammingDistance(a[i], b[i]), 30);
    EXPECT_GT(hammingDistance(a[i], b[(i + 37) % a.size()]), 60);
  }
}

TEST(Brief, LeavesOutWhatIsTooNearToTheEdge) {
  const cv::Mat1b image = texturedImage(200, 100, 2);
  const BriefExtractor brief(BriefPattern::generate(1, 49));
  const float r = static_cast<float>(brief.border());
  const auto described = brief.describe(
      image, {{r - 1, 50}, {r, r}, {199 - r, 99 - r}, {200 - r, 50}, {100, 100 - r}, {-5, 1e6F}});
  EXPECT_EQ(described.indices, (std::vector<std::size_t>{1, 2}));
  EXPECT_THROW(brief.describe(cv::Mat(100, 200, CV_8UC3), {}), InputError);
}

TEST(Brief, DoesNotDependOnThreads) {
  const cv::Mat1b image = texturedImage(752, 480, 3);
  const BriefExtractor brief(BriefPattern::generate(1, 49));
  std::vector<cv::Point2f> pixels;
  for (int i = 0; i < 400; ++i) pixels.emplace_back(30 + 1.7F * i, 30 + 1.03F * i);
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const auto alone = brief.describe(image, pixels).descriptors;
  cv::setNumThreads(4);
  const auto together = brief.describe(image, pixels).descriptors;
  cv::setNumThreads(threads);
  EXPECT_EQ(alone, together);
}

}  // namespace
}  // namespace vins::pose_graph
