#pragma once

#include <cstddef>
#include <string>

namespace vins::pipeline {

/// Compressed bytes, decompressed.
struct ChunkBytes {
  std::string bytes;
  bool is_whole = false;  ///< up to the end that the compression marks
};

/// Decompresses a bag's chunk as far as it goes, up to `most` bytes. Memory grows by what comes
/// out, not by what a header claims. `compression`: "lz4" or "bz2"; throws BagDamage for others.
ChunkBytes decompressChunk(const std::string& compression, const std::string& packed,
                           std::size_t most);

}  // namespace vins::pipeline
