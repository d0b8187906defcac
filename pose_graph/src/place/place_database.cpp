#include "pose_graph/place/place_database.h"

#include <algorithm>
#include <string>

#include "vins_core/input_error.h"

namespace vins::pose_graph {
namespace {

bool isBetter(const PlaceScore& a, const PlaceScore& b) {
  return a.score > b.score || (a.score == b.score && a.id < b.id);
}

}  // namespace

PlaceDatabase::PlaceDatabase(std::size_t word_count) : postings_(word_count) {}

void PlaceDatabase::add(std::int64_t id, const BagOfWords& bag) {
  if (contains(id))
    throw InputError("place database: id " + std::to_string(id) + " is there twice");
  if (!bag.empty() && bag.back().word >= postings_.size()) {
    throw InputError("place database: found word " + std::to_string(bag.back().word) +
                     "; allowed: below " + std::to_string(postings_.size()));
  }
  if (free_slots_.empty()) {
    free_slots_.push_back(static_cast<std::uint32_t>(places_.size()));
    places_.emplace_back();
  }
  const std::uint32_t slot = free_slots_.back();
  free_slots_.pop_back();
  slots_[id] = slot;
  places_[slot].id = id;
  for (const WordWeight& entry : bag) {
    postings_[entry.word].push_back({slot, entry.weight});
    places_[slot].words.push_back(entry.word);
  }
}

std::size_t PlaceDatabase::memory() const {
  std::size_t bytes = postings_.capacity() * sizeof(postings_[0]);
  for (const auto& list : postings_) bytes += list.capacity() * sizeof(Posting);
  for (const Slot& place : places_) {
    bytes += sizeof(Slot) + place.words.capacity() * sizeof(place.words[0]);
  }
  return bytes;
}

bool PlaceDatabase::remove(std::int64_t id) {
  const auto found = slots_.find(id);
  if (found == slots_.end()) return false;
  const std::uint32_t slot = found->second;
  for (const std::uint32_t word : places_[slot].words) {
    auto& list = postings_[word];
    list.erase(std::find_if(list.begin(), list.end(),
                            [slot](const Posting& posting) { return posting.slot == slot; }));
  }
  places_[slot].words.clear();
  free_slots_.push_back(slot);
  slots_.erase(found);
  return true;
}

std::vector<std::int64_t> PlaceDatabase::ids() const {
  std::vector<std::int64_t> ids;
  ids.reserve(slots_.size());
  for (const auto& entry : slots_) ids.push_back(entry.first);
  return ids;
}

std::vector<PlaceScore> PlaceDatabase::query(const BagOfWords& bag, std::size_t most,
                                             std::int64_t ids_below) const {
  std::vector<double> scores(places_.size(), 0.0);
  for (const WordWeight& entry : bag) {
    if (entry.word >= postings_.size()) continue;
    for (const Posting& posting : postings_[entry.word]) {
      scores[posting.slot] += std::min(entry.weight, posting.weight);
    }
  }
  std::vector<PlaceScore> results;
  for (std::size_t slot = 0; slot < scores.size(); ++slot) {
    const std::int64_t id = places_[slot].id;
    if (scores[slot] > 0.0 && id < ids_below) results.push_back({id, scores[slot]});
  }
  const std::size_t count = std::min(most, results.size());
  std::partial_sort(results.begin(), results.begin() + static_cast<std::ptrdiff_t>(count),
                    results.end(), isBetter);
  results.resize(count);
  return results;
}

}  // namespace vins::pose_graph
