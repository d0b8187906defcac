#include "pose_graph/place/vocabulary.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

[[noreturn]] void reject(const std::string& reason) { throw InputError("vocabulary: " + reason); }

/// One entry for each word that occurs, its weight being the sum of the word's weights.
BagOfWords countWords(std::vector<std::uint32_t> words, const std::vector<float>& weights) {
  std::sort(words.begin(), words.end());
  BagOfWords bag;
  for (const std::uint32_t word : words) {
    if (weights[word] <= 0.0F) continue;
    if (bag.empty() || bag.back().word != word) bag.push_back({word, 0.0F});
    bag.back().weight += weights[word];
  }
  return bag;
}

}  // namespace

Vocabulary::Vocabulary(int branching, int levels, std::vector<BriefDescriptor> descriptors,
                       const std::vector<std::uint32_t>& child_counts, std::vector<float> weights)
    : branching_(branching),
      levels_(levels),
      descriptors_(std::move(descriptors)),
      weights_(std::move(weights)) {
  if (branching_ < 2 || branching_ > 1000) reject("branching must be 2 to 1000");
  if (levels_ < 1 || levels_ > 30) reject("levels must be 1 to 30");
  if (descriptors_.size() < 2 || descriptors_.size() > kMostNodes) {
    reject("found " + std::to_string(descriptors_.size()) + " nodes; allowed: 2 to 2^26");
  }
  if (child_counts.size() != descriptors_.size()) reject("not one child count for each node");
  linkNodes(child_counts);
  for (const float weight : weights_) {
    if (!std::isfinite(weight) || weight < 0.0F) reject("a word's weight is not 0 or more");
  }
}

void Vocabulary::linkNodes(const std::vector<std::uint32_t>& child_counts) {
  links_.resize(child_counts.size());
  std::size_t next_child = 1, next_word = 0;
  // Nodes up to here are at most `level` steps from the root.
  std::size_t level_end = 1;
  int level = 0;
  for (std::size_t node = 0; node < links_.size(); ++node) {
    if (node >= next_child) reject("node " + std::to_string(node) + " has no parent");
    if (node == level_end) {
      level_end = next_child;
      ++level;
    }
    const std::uint32_t count = child_counts[node];
    if (count > static_cast<std::uint32_t>(branching_) || next_child + count > links_.size()) {
      reject("node " + std::to_string(node) + " has too many children");
    }
    if (count > 0 && level >= levels_) reject("the tree is deeper than its levels");
    links_[node] = {static_cast<std::uint32_t>(count > 0 ? next_child : next_word), count};
    next_child += count;
    next_word += count == 0 ? 1 : 0;
  }
  if (next_word != weights_.size()) {
    reject("found " + std::to_string(weights_.size()) + " weights for " +
           std::to_string(next_word) + " words");
  }
}

Vocabulary::Place Vocabulary::find(const BriefDescriptor& descriptor, int node_level) const {
  Place place;
  std::uint32_t node = 0;
  for (int level = 0; links_[node].child_count > 0; ++level) {
    const Link& link = links_[node];
    node =
        link.first_child +
        static_cast<std::uint32_t>(
            nearestDescriptor(descriptor, &descriptors_[link.first_child], link.child_count).index);
    if (level < node_level) place.node = node;
  }
  place.word = links_[node].first_child;
  return place;
}

ImageWords Vocabulary::describe(const std::vector<BriefDescriptor>& descriptors,
                                int node_level) const {
  ImageWords result;
  std::vector<std::uint32_t> words;
  for (const BriefDescriptor& descriptor : descriptors) {
    const Place place = find(descriptor, node_level);
    words.push_back(place.word);
    result.nodes.push_back(place.node);
  }
  result.bag = countWords(std::move(words), weights_);
  double sum = 0.0;
  for (const WordWeight& entry : result.bag) sum += entry.weight;
  for (WordWeight& entry : result.bag) entry.weight = static_cast<float>(entry.weight / sum);
  return result;
}

double bagScore(const BagOfWords& a, const BagOfWords& b) {
  // Of positive weights of sum one, 1 - |a - b| / 2 is the sum of the lesser ones.
  double score = 0.0;
  auto at = b.begin();
  for (const WordWeight& entry : a) {
    while (at != b.end() && at->word < entry.word) ++at;
    if (at == b.end()) break;
    if (at->word == entry.word) score += std::min(entry.weight, at->weight);
  }
  return score;
}

}  // namespace vins::pose_graph
