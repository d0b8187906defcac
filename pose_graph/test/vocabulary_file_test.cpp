#include "pose_graph/place/vocabulary_file.h"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "pose_graph/place/vocabulary_training.h"
#include "random_descriptors.h"
#include "vins_core/input_error.h"
#include "vins_core/text_file.h"

namespace vins::pose_graph {
namespace {

using testing::randomDescriptors;

Vocabulary smallVocabulary() {
  VocabularyTrainingOptions options;
  options.branching = 4;
  options.levels = 3;
  return trainVocabulary(
      {randomDescriptors(80, 1), randomDescriptors(80, 2), randomDescriptors(80, 3)}, options);
}

template <typename Number>
void append(const Number& number, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&number), sizeof(Number));
}

template <typename Number>
void put(const Number& number, std::size_t at, std::string* bytes) {
  std::memcpy(bytes->data() + at, &number, sizeof(Number));
}

/// A vocabulary in VINS-Mono's form; nodes are written in an order of their own: the last first.
std::string inForeignForm(const Vocabulary& vocabulary) {
  const auto nodes = static_cast<std::int32_t>(vocabulary.nodeCount()) - 1;
  const auto words = static_cast<std::int32_t>(vocabulary.wordCount());
  std::vector<std::int32_t> parents(nodes + 1, 0), word_nodes;
  std::vector<double> weights(nodes + 1, 0.0);
  std::int32_t next_child = 1;
  for (std::int32_t node = 0; node <= nodes; ++node) {
    for (std::uint32_t i = 0; i < vocabulary.childCount(node); ++i) parents[next_child++] = node;
    if (vocabulary.childCount(node) > 0) continue;
    weights[node] = vocabulary.weight(static_cast<std::uint32_t>(word_nodes.size()));
    word_nodes.push_back(node);
  }
  std::string bytes;
  for (const std::int32_t number :
       {vocabulary.branching(), vocabulary.levels(), 0, 0, nodes, words}) {
    append(number, &bytes);
  }
  for (std::int32_t node = nodes; node > 0; --node) {
    append(node, &bytes);
    append(parents[node], &bytes);
    append(weights[node], &bytes);
    append(vocabulary.descriptor(node), &bytes);
  }
  for (std::int32_t word = words - 1; word >= 0; --word) {
    append(word_nodes[word], &bytes);
    append(word, &bytes);
  }
  return bytes;
}

void expectEqual(const Vocabulary& a, const Vocabulary& b) {
  EXPECT_EQ(a.branching(), b.branching());
  EXPECT_EQ(a.levels(), b.levels());
  ASSERT_EQ(a.nodeCount(), b.nodeCount());
  ASSERT_EQ(a.wordCount(), b.wordCount());
  for (std::uint32_t node = 1; node < a.nodeCount(); ++node) {
    EXPECT_EQ(a.descriptor(node), b.descriptor(node));
    EXPECT_EQ(a.childCount(node), b.childCount(node));
  }
  for (std::uint32_t word = 0; word < a.wordCount(); ++word) {
    EXPECT_EQ(a.weight(word), b.weight(word));
  }
}

class VocabularyFile : public ::testing::Test {
 protected:
  void TearDown() override { std::remove(path_.c_str()); }

  std::string ownForm() const {
    writeVocabulary(path_, smallVocabulary());
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  /// What reading these bytes complains of; fails the test where it does not name the file.
  std::string complaint(const std::string& bytes) const {
    writeTextFile(path_, bytes);
    try {
      readVocabulary(path_);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).compare(0, path_.size(), path_), 0) << error.what();
      return error.what();
    }
    return "";
  }

  void expectComplaint(const std::string& bytes, const std::string& part) const {
    const std::string text = complaint(bytes);
    EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
  }

  const std::string path_ = ::testing::TempDir() + "vocabulary_file_test.bin";
};

TEST_F(VocabularyFile, IsReadAsItWasWritten) {
  writeVocabulary(path_, smallVocabulary());
  expectEqual(smallVocabulary(), readVocabulary(path_));
}

TEST_F(VocabularyFile, InVinsMonosFormIsRead) {
  writeTextFile(path_, inForeignForm(smallVocabulary()));
  expectEqual(smallVocabulary(), readVocabulary(path_));
}

TEST_F(VocabularyFile, CutAnywhereIsNamed) {
  for (const std::string& bytes : {ownForm(), inForeignForm(smallVocabulary())}) {
    EXPECT_EQ(complaint(bytes), "");
    for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 10) {
      EXPECT_NE(complaint(bytes.substr(0, length)), "") << length;
    }
    EXPECT_NE(complaint(bytes.substr(0, bytes.size() - 1)), "");
    EXPECT_NE(complaint(bytes + '\0'), "");
  }
}

TEST_F(VocabularyFile, WithAnyByteChangedIsNamed) {
  const std::string bytes = ownForm();
  for (std::size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 500) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    EXPECT_NE(complaint(damaged), "") << at;
  }
}

TEST_F(VocabularyFile, HugeNumbersAreNamedWithoutHugeMemory) {
  std::string own = ownForm();
  put(std::uint32_t{0xffffffff}, 20, &own);
  expectComplaint(own, "ends early");
  std::string foreign = inForeignForm(smallVocabulary());
  put(std::int32_t{0x7fffffff}, 16, &foreign);
  expectComplaint(foreign, "ends early");
}

TEST_F(VocabularyFile, OtherFilesAreNamed) {
  expectComplaint("", "ends early");
  expectComplaint("%YAML:1.0\n---\nx1: [ 1, 2, 3, 4, 5, 6 ]\n", "is no vocabulary");
  expectComplaint(std::string(1000, '\0'), "is no vocabulary");
  std::string newer = ownForm();
  put(std::uint32_t{2}, 8, &newer);
  expectComplaint(newer, "version is 2");
  EXPECT_THROW(readVocabulary("/nowhere/vocabulary.bin"), InputError);
  EXPECT_THROW(readVocabulary(::testing::TempDir()), InputError) << "a folder";
}

TEST_F(VocabularyFile, BrokenTreesInVinsMonosFormAreNamed) {
  const std::string bytes = inForeignForm(smallVocabulary());
  constexpr std::size_t kFirstNode = 24;
  const auto nodes = static_cast<std::int32_t>(smallVocabulary().nodeCount()) - 1;
  const std::size_t first_word = kFirstNode + 48 * static_cast<std::size_t>(nodes);
  const auto with = [&bytes](std::int32_t number, std::size_t at) {
    std::string changed = bytes;
    put(number, at, &changed);
    return changed;
  };
  expectComplaint(with(nodes + 1, kFirstNode), "has the id");
  expectComplaint(with(-7, kFirstNode), "has the id");
  expectComplaint(with(1, kFirstNode), "has the id");
  expectComplaint(with(-1, kFirstNode + 4), "has the parent");
  expectComplaint(with(nodes + 1, kFirstNode + 4), "has the parent");
  expectComplaint(with(nodes, kFirstNode + 4), "has the parent");
  expectComplaint(with(0, first_word), "word record 0");
  expectComplaint(with(1 << 30, first_word), "word record 0");
  expectComplaint(with(-1, first_word + 4), "word record 0");
  // The root's first child under the last leaf's parent: a ring, or a node that has too many.
  EXPECT_NE(complaint(with(nodes, first_word - 48 + 4)), "");
}

}  // namespace
}  // namespace vins::pose_graph
