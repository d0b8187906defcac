#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace vins::pose_graph {

/// All bytes of a file. Throws InputError naming it where it is no file or cannot be read.
std::string readBytes(const std::string& path);

constexpr std::uint64_t kChecksumStart = 0xcbf29ce484222325U;

/// FNV-1a of 64 bits (G. Fowler, L. C. Noll, K.-P. Vo). One changed byte always changes it. `start`
/// is the checksum of what comes before.
std::uint64_t checksum(const char* bytes, std::size_t count, std::uint64_t start = kChecksumStart);

/// The bytes of a number, or of a record of numbers without gaps.
template <typename Number>
void append(const Number& number, std::string* bytes) {
  static_assert(std::is_trivially_copyable_v<Number>, "bytes must be all there is");
  bytes->append(reinterpret_cast<const char*>(&number), sizeof(Number));
}

template <typename Number>
void append(const std::vector<Number>& numbers, std::string* bytes) {
  static_assert(std::is_trivially_copyable_v<Number>, "bytes must be all there is");
  bytes->append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
}

}  // namespace vins::pose_graph
