// The pose graph's maps: what is saved, and what becomes of a map that is loaded.

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "pose_graph/pose_graph.h"
#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

/// Keyframes and sequences counted from 0 on, in their order, as a file has them.
class StoredNumbers {
 public:
  explicit StoredNumbers(const KeyframeGraph& graph) {
    for (const auto& [id, vertex] : graph.vertices()) {
      ids_.emplace(id, static_cast<std::int64_t>(ids_.size()));
      sequences_.emplace(vertex.sequence, 0);
    }
    SequenceNumber next = 0;
    for (auto& [sequence, number] : sequences_) number = next++;
  }

  KeyframeVertex of(KeyframeVertex vertex) const {
    vertex.id = ids_.at(vertex.id);
    vertex.sequence = sequences_.at(vertex.sequence);
    return vertex;
  }

  LoopEdge of(LoopEdge loop) const {
    loop.query_id = ids_.at(loop.query_id);
    loop.old_id = ids_.at(loop.old_id);
    return loop;
  }

 private:
  std::map<std::int64_t, std::int64_t> ids_;
  std::map<SequenceNumber, SequenceNumber> sequences_;
};

/// What is added to a stored map's numbers, so that they are negative and below all that are there.
struct NumberOffsets {
  std::int64_t id = 0;
  SequenceNumber sequence = 0;

  NumberOffsets(const StoredMap& map, const KeyframeGraph& graph) {
    SequenceNumber highest = 0;
    for (const MapKeyframe& keyframe : map.keyframes) {
      highest = std::max(highest, keyframe.vertex.sequence);
    }
    const auto& vertices = graph.vertices();
    const std::vector<SequenceNumber> sequences = graph.sequences();
    const std::int64_t lowest_id = vertices.empty() ? 0 : vertices.begin()->first;
    const SequenceNumber lowest = sequences.empty() ? 0 : sequences.front();
    id = std::min<std::int64_t>(0, lowest_id) - static_cast<std::int64_t>(map.keyframes.size());
    sequence = std::min<SequenceNumber>(0, lowest) - highest - 1;
  }
};

void shift(const NumberOffsets& offsets, StoredMap* map) {
  for (MapKeyframe& keyframe : map->keyframes) {
    keyframe.vertex.id += offsets.id;
    keyframe.vertex.sequence += offsets.sequence;
    if (keyframe.view) keyframe.view->id += offsets.id;
  }
  for (LoopEdge& loop : map->loops) {
    loop.query_id += offsets.id;
    loop.old_id += offsets.id;
  }
}

std::vector<KeyframeVertex> verticesOf(const StoredMap& map) {
  std::vector<KeyframeVertex> vertices;
  for (const MapKeyframe& keyframe : map.keyframes) vertices.push_back(keyframe.vertex);
  return vertices;
}

LoadedMap summaryOf(const StoredMap& map) {
  LoadedMap summary;
  summary.keyframes = map.keyframes.size();
  summary.loops = map.loops.size();
  std::map<SequenceNumber, int> sequences;
  for (const MapKeyframe& keyframe : map.keyframes) {
    sequences.emplace(keyframe.vertex.sequence, 0);
    summary.without_view += keyframe.view ? 0 : 1;
  }
  summary.sequences = sequences.size();
  return summary;
}

}  // namespace

std::string LoadedMap::describe() const {
  std::ostringstream text;
  text << keyframes << " keyframes of " << sequences << (sequences == 1 ? " run, " : " runs, ")
       << loops << " loops";
  if (without_view > 0) text << "; " << without_view << " keyframes have no view";
  if (!same_vocabulary) text << "; made with another vocabulary: words were found anew";
  return text.str();
}

std::size_t PoseGraph::save(const std::string& path, const PictureStore* pictures) {
  // A copy: the optimization shall not wait for the disk.
  const KeyframeGraph graph = graph_.use([](const KeyframeGraph& shared) { return shared; });
  if (graph.vertices().empty()) throw InputError(path + ": not written: there is no keyframe yet");
  const StoredNumbers numbers(graph);
  MapWriter writer(identityOf(finder_.places()), graph.vertices().size(), graph.loops().size());
  for (const auto& [id, vertex] : graph.vertices()) {
    writer.addKeyframe(numbers.of(vertex), finder_.view(id),
                       pictures == nullptr ? std::vector<unsigned char>() : pictures->encoded(id));
  }
  std::vector<LoopEdge> loops;
  for (const LoopEdge& loop : graph.loops()) loops.push_back(numbers.of(loop));
  writer.addLoops(loops);
  writer.write(path);
  return graph.vertices().size();
}

LoadedMap PoseGraph::load(const std::string& path, PictureStore* pictures) {
  StoredMap map = readMap(path);
  const PlaceModelIdentity own = identityOf(finder_.places());
  if (map.places.pattern != own.pattern) {
    throw InputError(path +
                     ": was made with another brief_pattern_file, whose descriptors cannot "
                     "be compared; allowed: maps made with the one in use");
  }
  LoadedMap loaded = summaryOf(map);
  loaded.same_vocabulary = map.places == own;
  graph_.use([&map](KeyframeGraph& graph) {
    shift(NumberOffsets(map, graph), &map);
    graph.addStored(verticesOf(map), map.loops);
  });
  for (MapKeyframe& keyframe : map.keyframes) {
    if (keyframe.view) finder_.addStored(std::move(*keyframe.view));
    if (pictures == nullptr) continue;
    pictures->addEncoded(keyframe.vertex.id, std::move(keyframe.picture));
  }
  removeRedundant();
  return loaded;
}

}  // namespace vins::pose_graph
