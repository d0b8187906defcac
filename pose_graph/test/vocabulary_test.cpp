#include "pose_graph/place/vocabulary.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "pose_graph/place/vocabulary_training.h"
#include "random_descriptors.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

using testing::randomDescriptors;
using testing::withNoise;

/// Images that each show some of `themes`, with a few bits of noise.
std::vector<std::vector<BriefDescriptor>> imagesOf(const std::vector<BriefDescriptor>& themes,
                                                   int images, int per_image) {
  std::mt19937_64 random(9);
  std::vector<std::vector<BriefDescriptor>> result(images);
  for (auto& image : result) {
    for (int i = 0; i < per_image; ++i) {
      image.push_back(withNoise(themes[random() % themes.size()], 8, &random));
    }
  }
  return result;
}

VocabularyTrainingOptions smallTree() {
  VocabularyTrainingOptions options;
  options.branching = 8;
  options.levels = 3;
  return options;
}

TEST(VocabularyTraining, FindsTheThemesAgain) {
  const auto themes = randomDescriptors(60, 1);
  const Vocabulary vocabulary = trainVocabulary(imagesOf(themes, 50, 60), smallTree());
  std::mt19937_64 random(2);
  std::set<std::uint32_t> words;
  int agreeing = 0;
  for (const BriefDescriptor& theme : themes) {
    const std::uint32_t word = vocabulary.find(theme, 0).word;
    words.insert(word);
    agreeing += vocabulary.find(withNoise(theme, 8, &random), 0).word == word ? 1 : 0;
  }
  // Clusters of 8 bits' noise lie over 100 bits apart. A seed that two of them share, or a cluster
  // that the last level splits, is the exception.
  EXPECT_GE(words.size(), 50u);
  EXPECT_GE(agreeing, 50);
}

TEST(VocabularyTraining, IsTheSameForTheSameSeed) {
  const auto images = imagesOf(randomDescriptors(60, 1), 20, 50);
  const Vocabulary a = trainVocabulary(images, smallTree()),
                   b = trainVocabulary(images, smallTree());
  ASSERT_EQ(a.nodeCount(), b.nodeCount());
  for (std::uint32_t node = 0; node < a.nodeCount(); ++node) {
    ASSERT_EQ(a.descriptor(node), b.descriptor(node));
    ASSERT_EQ(a.childCount(node), b.childCount(node));
  }
  auto options = smallTree();
  options.seed = 2;
  const Vocabulary c = trainVocabulary(images, options);
  bool differs = c.nodeCount() != a.nodeCount();
  for (std::uint32_t i = 0; !differs && i < a.nodeCount(); ++i) {
    differs = c.descriptor(i) != a.descriptor(i);
  }
  EXPECT_TRUE(differs);
}

TEST(VocabularyTraining, KeepsToBranchingAndLevels) {
  const auto images = imagesOf(randomDescriptors(400, 1), 20, 300);
  const Vocabulary vocabulary = trainVocabulary(images, smallTree());
  EXPECT_LE(vocabulary.wordCount(), 8u * 8 * 8);
  EXPECT_GE(vocabulary.wordCount(), 200u);
  for (std::uint32_t node = 0; node < vocabulary.nodeCount(); ++node) {
    EXPECT_LE(vocabulary.childCount(node), 8u);
    EXPECT_NE(vocabulary.childCount(node), 1u) << "a single child tells nothing";
  }
}

TEST(VocabularyTraining, WeighsWordsByTheirRarity) {
  const auto themes = randomDescriptors(8, 1);
  std::vector<std::vector<BriefDescriptor>> images;
  std::mt19937_64 random(3);
  for (int i = 0; i < 40; ++i) {
    images.push_back({withNoise(themes[0], 4, &random), withNoise(themes[1 + i % 4], 4, &random)});
  }
  auto options = smallTree();
  options.levels = 1;
  const Vocabulary vocabulary = trainVocabulary(images, options);
  // Eight seeds for five themes: the common one may be split, so it is in many images, not all.
  EXPECT_LT(vocabulary.weight(vocabulary.find(themes[0], 0).word), std::log(4.0));
  EXPECT_GE(vocabulary.weight(vocabulary.find(themes[1], 0).word), std::log(4.0) - 1e-6);
}

TEST(VocabularyTraining, RefusesWhatCannotBeTrainedOn) {
  EXPECT_THROW(trainVocabulary({}, {}), InputError);
  EXPECT_THROW(trainVocabulary({randomDescriptors(50, 1)}, {}), InputError);
  const std::vector<BriefDescriptor> alike(50, BriefDescriptor{});
  EXPECT_THROW(trainVocabulary({alike, alike}, {}), InputError);
  VocabularyTrainingOptions options;
  options.branching = 1;
  EXPECT_THROW(trainVocabulary({}, options), InputError);
}

/// Root, two children 0000 and 1111, of which the second has two: its own and one with a bit less.
Vocabulary handMade() {
  BriefDescriptor zeros{}, ones{}, almost{};
  ones.fill(~std::uint64_t{0});
  almost = ones;
  almost[2] = 0;
  return {2, 2, {zeros, zeros, ones, ones, almost}, {2, 0, 2, 0, 0}, {1.0F, 2.0F, 3.0F}};
}

TEST(Vocabulary, WalksDownTheTree) {
  const Vocabulary vocabulary = handMade();
  EXPECT_EQ(vocabulary.wordCount(), 3u);
  const BriefDescriptor& almost = vocabulary.descriptor(4);
  EXPECT_EQ(vocabulary.find(BriefDescriptor{}, 0).word, 0u);
  EXPECT_EQ(vocabulary.find(vocabulary.descriptor(3), 0).word, 1u);
  EXPECT_EQ(vocabulary.find(almost, 0).word, 2u);
  EXPECT_EQ(vocabulary.find(almost, 0).node, 0u);
  EXPECT_EQ(vocabulary.find(almost, 1).node, 2u);
  EXPECT_EQ(vocabulary.find(almost, 2).node, 4u);
  EXPECT_EQ(vocabulary.find(almost, 9).node, 4u) << "the leaf, where it lies higher";
}

TEST(Vocabulary, MakesBagsOfSumOne) {
  const Vocabulary vocabulary = handMade();
  const BriefDescriptor zeros{}, almost = vocabulary.descriptor(4);
  const ImageWords words = vocabulary.describe({almost, zeros, almost}, 1);
  EXPECT_EQ(words.nodes, (std::vector<std::uint32_t>{2, 1, 2}));
  ASSERT_EQ(words.bag.size(), 2u);
  EXPECT_EQ(words.bag[0].word, 0u);
  EXPECT_FLOAT_EQ(words.bag[0].weight, 1.0F / 7.0F);
  EXPECT_FLOAT_EQ(words.bag[1].weight, 6.0F / 7.0F);
  EXPECT_TRUE(vocabulary.describe({}, 1).bag.empty());
}

TEST(Vocabulary, RefusesTreesThatAreNone) {
  const std::vector<BriefDescriptor> three(3);
  EXPECT_NO_THROW(Vocabulary(2, 1, three, {2, 0, 0}, {1, 1}));
  EXPECT_THROW(Vocabulary(2, 1, three, {1, 0, 0}, {1, 1}), InputError) << "no parent";
  EXPECT_THROW(Vocabulary(2, 1, three, {2, 2, 0}, {1, 1}), InputError) << "too many children";
  EXPECT_THROW(Vocabulary(2, 1, three, {1, 1, 0}, {1}), InputError) << "too deep";
  EXPECT_THROW(Vocabulary(2, 1, three, {2, 0, 0}, {1}), InputError) << "a weight missing";
  EXPECT_THROW(Vocabulary(2, 1, three, {2, 0, 0}, {1, -1}), InputError) << "negative weight";
  EXPECT_THROW(Vocabulary(2, 1, three, {2, 0, 0}, {1, NAN}), InputError) << "no number";
  EXPECT_THROW(Vocabulary(1, 1, three, {2, 0, 0}, {1, 1}), InputError) << "branching";
  EXPECT_THROW(Vocabulary(2, 1, {}, {}, {}), InputError) << "no nodes";
}

TEST(BagScore, IsOneMinusHalfTheL1Distance) {
  const BagOfWords a{{1, 0.5F}, {4, 0.25F}, {7, 0.25F}}, b{{1, 0.25F}, {5, 0.25F}, {7, 0.5F}};
  // |a - b| = 0.25 + 0.25 + 0.25 + 0.25.
  EXPECT_DOUBLE_EQ(bagScore(a, b), 0.5);
  EXPECT_DOUBLE_EQ(bagScore(b, a), 0.5);
  EXPECT_DOUBLE_EQ(bagScore(a, a), 1.0);
  EXPECT_DOUBLE_EQ(bagScore(a, {{2, 1.0F}}), 0.0);
  EXPECT_DOUBLE_EQ(bagScore(a, {}), 0.0);
}

}  // namespace
}  // namespace vins::pose_graph
