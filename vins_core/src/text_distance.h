#pragma once

#include <string>
#include <vector>

namespace vins {

/// Levenshtein distance: insertions, deletions and replacements that turn `a` into `b`.
std::size_t textDistance(const std::string& a, const std::string& b);

/// The word of `candidates` nearest to `word`, or "" where none is near enough to be a slip.
std::string nearestWord(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace vins
