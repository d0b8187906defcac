#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pose_graph/place/descriptor.h"

namespace vins::pose_graph {

/// How much of one visual word an image holds.
struct WordWeight {
  std::uint32_t word = 0;
  float weight = 0.0F;

  bool operator==(const WordWeight& other) const {
    return word == other.word && weight == other.weight;
  }
};

/// An image as a bag of words: words rising, weights positive, of sum 1; or empty.
using BagOfWords = std::vector<WordWeight>;

/// What a vocabulary says of an image.
struct ImageWords {
  BagOfWords bag;
  std::vector<std::uint32_t> nodes;  ///< of each descriptor, its ancestor at the asked level
};

/// A tree of descriptors, by which a descriptor finds its visual word: D. Nister, H. Stewenius,
/// "Scalable recognition with a vocabulary tree", CVPR 2006. Each node's children share its
/// descriptors out among them; the leaves are the words. Immutable: may be shared between threads.
class Vocabulary {
 public:
  /// The largest tree that is taken [nodes]: memory is not given to a broken file.
  static constexpr std::size_t kMostNodes = 1U << 26;

  /// Of a tree whose nodes come level by level, the root (whose descriptor means nothing) first,
  /// so that the children of a node lie in a row, in their parents' order. `child_counts` has one
  /// number for each node, `weights` one for each leaf, in the nodes' order: this is how words are
  /// numbered. Throws InputError saying what does not fit.
  Vocabulary(int branching, int levels, std::vector<BriefDescriptor> descriptors,
             const std::vector<std::uint32_t>& child_counts, std::vector<float> weights);

  int branching() const { return branching_; }  ///< children that a node has at most
  int levels() const { return levels_; }        ///< steps from the root to a word at most
  std::size_t nodeCount() const { return descriptors_.size(); }
  std::size_t wordCount() const { return weights_.size(); }

  const BriefDescriptor& descriptor(std::uint32_t node) const { return descriptors_[node]; }
  std::uint32_t childCount(std::uint32_t node) const { return links_[node].child_count; }

  /// Inverse document frequency of a word, ln(images / images with the word) of the training.
  float weight(std::uint32_t word) const { return weights_[word]; }

  /// The leaf to which a descriptor belongs, and the node it passes at a level.
  struct Place {
    std::uint32_t word = 0;
    std::uint32_t node = 0;  ///< at the asked level, or the leaf where that lies higher
  };

  /// At each node the nearest child, the first of equally near ones. Level 0 is the root.
  Place find(const BriefDescriptor& descriptor, int node_level) const;

  /// The bag of words of an image's descriptors, by term frequency times inverse document
  /// frequency, of L1 norm one; empty where no word has a weight.
  ImageWords describe(const std::vector<BriefDescriptor>& descriptors, int node_level) const;

 private:
  struct Link {
    std::uint32_t first_child = 0;  ///< of a leaf: its word
    std::uint32_t child_count = 0;
  };

  void linkNodes(const std::vector<std::uint32_t>& child_counts);

  int branching_;
  int levels_;
  std::vector<BriefDescriptor> descriptors_;  ///< one for each node
  std::vector<Link> links_;                   ///< one for each node
  std::vector<float> weights_;                ///< one for each word
};

/// The L1 score of two bags, 1 - |a - b| / 2: 1 for equal ones, 0 where they share no word (Galvez-
/// Lopez & Tardos, "Bags of binary words for fast place recognition in image sequences", T-RO 2012,
/// equation 1).
double bagScore(const BagOfWords& a, const BagOfWords& b);

}  // namespace vins::pose_graph
