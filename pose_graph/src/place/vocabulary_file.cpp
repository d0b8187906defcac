#include "pose_graph/place/vocabulary_file.h"

#include <utility>

#include "place/binary_file.h"
#include "place/byte_reader.h"
#include "vins_core/text_file.h"

namespace vins::pose_graph {
namespace {

const char* const kMagic = "VINSVOCB";
constexpr std::size_t kMagicLength = 8;
constexpr std::uint32_t kVersion = 1;

Vocabulary parseOwn(const std::string& bytes, const std::string& path) {
  ByteReader reader(bytes, path);
  reader.takeMany<char>(kMagicLength);
  const auto version = reader.take<std::uint32_t>();
  if (version != kVersion) {
    reader.fail("version is " + std::to_string(version) + "; readable: 1");
  }
  const auto branching = reader.take<std::uint32_t>();
  const auto levels = reader.take<std::uint32_t>();
  const auto nodes = reader.take<std::uint32_t>();
  if (branching > 1000 || levels > 30) reader.fail("branching or levels cannot be so large");
  auto descriptors = reader.takeMany<BriefDescriptor>(nodes);
  const auto child_counts = reader.takeMany<std::uint32_t>(nodes);
  if (reader.left() < sizeof(std::uint64_t)) reader.fail("the file ends early");
  const std::size_t weights_length = reader.left() - sizeof(std::uint64_t);
  if (weights_length % sizeof(float) != 0) reader.fail("the weights are no whole number of floats");
  auto weights = reader.takeMany<float>(weights_length / sizeof(float));
  if (reader.take<std::uint64_t>() != checksum(bytes.data(), bytes.size() - 8)) {
    reader.fail("the checksum does not fit: the file is damaged");
  }
  return {static_cast<int>(branching), static_cast<int>(levels), std::move(descriptors),
          child_counts, std::move(weights)};
}

struct ForeignHeader {
  std::int32_t branching, levels, scoring, weighting, nodes, words;
};

struct ForeignNode {
  std::int32_t id, parent;
  double weight;
  BriefDescriptor descriptor;
};

struct ForeignWord {
  std::int32_t node, word;
};

static_assert(sizeof(ForeignHeader) == 24 && sizeof(ForeignNode) == 48 && sizeof(ForeignWord) == 8,
              "as they lie in the file");

/// The nodes of VINS-Mono's form, on the way to another order.
class ForeignTree {
 public:
  ForeignTree(const std::vector<ForeignNode>& nodes, const ByteReader& reader)
      : nodes_(&nodes), by_id_(nodes.size() + 1, kNone), children_(nodes.size() + 2, 0) {
    const auto most = static_cast<std::int64_t>(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const ForeignNode& node = nodes[i];
      const std::string name = "node record " + std::to_string(i);
      if (node.id < 1 || node.id > most || by_id_[node.id] != kNone) {
        reader.fail(name + " has the id " + std::to_string(node.id) + "; allowed: each of 1 to " +
                    std::to_string(most) + " once");
      }
      if (node.parent < 0 || node.parent > most || node.parent == node.id) {
        reader.fail(name + " has the parent " + std::to_string(node.parent));
      }
      by_id_[node.id] = static_cast<std::uint32_t>(i);
      ++children_[node.parent + 1];
    }
    for (std::size_t i = 1; i < children_.size(); ++i) children_[i] += children_[i - 1];
    listChildren();
  }

  bool isLeaf(std::int32_t id) const { return children_[id] == children_[id + 1]; }

  /// Level by level. Nodes that hang in a ring are never reached: they are missed by number.
  Vocabulary sorted(const ForeignHeader& header, const ByteReader& reader) const {
    std::vector<std::int32_t> order{0};
    std::vector<BriefDescriptor> descriptors{BriefDescriptor{}};
    std::vector<std::uint32_t> counts;
    std::vector<float> weights;
    order.reserve(by_id_.size());
    descriptors.reserve(by_id_.size());
    counts.reserve(by_id_.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const std::int32_t id = order[i];
      for (std::uint32_t child = children_[id]; child < children_[id + 1]; ++child) {
        order.push_back(child_ids_[child]);
        descriptors.push_back(node(child_ids_[child]).descriptor);
      }
      counts.push_back(children_[id + 1] - children_[id]);
      if (isLeaf(id) && id > 0) weights.push_back(static_cast<float>(node(id).weight));
    }
    if (order.size() != nodes_->size() + 1) reader.fail("some nodes do not hang on the root");
    return {header.branching, header.levels, std::move(descriptors), counts, std::move(weights)};
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  const ForeignNode& node(std::int32_t id) const { return (*nodes_)[by_id_[id]]; }

  void listChildren() {
    child_ids_.resize(nodes_->size());
    std::vector<std::uint32_t> next(children_.begin(), children_.end());
    for (std::size_t id = 1; id < by_id_.size(); ++id) {
      child_ids_[next[node(static_cast<std::int32_t>(id)).parent]++] =
          static_cast<std::int32_t>(id);
    }
  }

  const std::vector<ForeignNode>* nodes_;
  std::vector<std::uint32_t> by_id_;     ///< which record
  std::vector<std::uint32_t> children_;  ///< where in child_ids_ those of a node begin
  std::vector<std::int32_t> child_ids_;
};

void checkWords(const std::vector<ForeignWord>& words, std::size_t nodes, const ForeignTree& tree,
                const ByteReader& reader) {
  std::vector<bool> seen(nodes + 1, false);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const ForeignWord& word = words[i];
    const bool is_node = word.node >= 1 && static_cast<std::size_t>(word.node) <= nodes;
    if (!is_node || !tree.isLeaf(word.node) || seen[word.node] || word.word < 0 ||
        static_cast<std::size_t>(word.word) >= words.size()) {
      reader.fail("word record " + std::to_string(i) + " has node " + std::to_string(word.node) +
                  " and word " + std::to_string(word.word) +
                  "; needed: each leaf once, words below " + std::to_string(words.size()));
    }
    seen[word.node] = true;
  }
}

Vocabulary parseForeign(const std::string& bytes, const std::string& path) {
  ByteReader reader(bytes, path);
  const auto header = reader.take<ForeignHeader>();
  const bool is_plausible = header.branching >= 2 && header.branching <= 1000 &&
                            header.levels >= 1 && header.levels <= 30 && header.scoring >= 0 &&
                            header.scoring <= 5 && header.weighting >= 0 && header.weighting <= 3 &&
                            header.nodes >= 2 && header.words >= 2 && header.words <= header.nodes;
  if (!is_plausible) {
    reader.fail(
        "is no vocabulary: neither \"VINSVOCB\" nor VINS-Mono's numbers of branching, "
        "levels, scoring, weighting, nodes and words");
  }
  const auto nodes = reader.takeMany<ForeignNode>(static_cast<std::size_t>(header.nodes));
  const auto words = reader.takeMany<ForeignWord>(static_cast<std::size_t>(header.words));
  if (reader.left() > 0) reader.fail(std::to_string(reader.left()) + " bytes too many");
  const ForeignTree tree(nodes, reader);
  checkWords(words, nodes.size(), tree, reader);
  return tree.sorted(header, reader);
}

}  // namespace

Vocabulary readVocabulary(const std::string& path) {
  const std::string bytes = readBytes(path);
  const bool is_own = bytes.compare(0, kMagicLength, kMagic) == 0;
  try {
    return is_own ? parseOwn(bytes, path) : parseForeign(bytes, path);
  } catch (const InputError& error) {
    const std::string message = error.what();
    throw InputError(message.compare(0, path.size(), path) == 0 ? message : path + ": " + message);
  }
}

void writeVocabulary(const std::string& path, const Vocabulary& vocabulary) {
  std::string bytes = kMagic;
  const auto nodes = static_cast<std::uint32_t>(vocabulary.nodeCount());
  append(kVersion, &bytes);
  append(static_cast<std::uint32_t>(vocabulary.branching()), &bytes);
  append(static_cast<std::uint32_t>(vocabulary.levels()), &bytes);
  append(nodes, &bytes);
  for (std::uint32_t node = 0; node < nodes; ++node) append(vocabulary.descriptor(node), &bytes);
  for (std::uint32_t node = 0; node < nodes; ++node) append(vocabulary.childCount(node), &bytes);
  for (std::uint32_t word = 0; word < vocabulary.wordCount(); ++word) {
    append(vocabulary.weight(word), &bytes);
  }
  append(checksum(bytes.data(), bytes.size()), &bytes);
  writeTextFile(path, bytes);
}

}  // namespace vins::pose_graph
