#include "chunk_bytes.h"

#include <algorithm>
#include <memory>
#include <new>

#include <bzlib.h>
#include <lz4frame.h>

#include "bag_records.h"

namespace vins::pipeline {
namespace {

constexpr std::size_t kStep = 1 << 18;  ///< by which the result grows [bytes]

ChunkBytes decompressLz4(const std::string& packed, std::size_t most) {
  LZ4F_dctx* created = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&created, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      created, LZ4F_freeDecompressionContext);
  ChunkBytes result;
  std::size_t used = 0, done = 0;
  while (done < most) {
    result.bytes.resize(std::min(most, done + kStep));
    std::size_t out = result.bytes.size() - done;
    std::size_t in = packed.size() - used;
    const std::size_t hint =
        LZ4F_decompress(context.get(), &result.bytes[done], &out, &packed[used], &in, nullptr);
    if (LZ4F_isError(hint)) break;
    used += in;
    done += out;
    result.is_whole = hint == 0;
    if (result.is_whole || (in == 0 && out == 0)) break;
  }
  result.bytes.resize(done);
  return result;
}

ChunkBytes decompressBz2(const std::string& packed, std::size_t most) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> end(&stream,
                                                                       BZ2_bzDecompressEnd);
  // The library reads only, but takes no constant.
  stream.next_in = const_cast<char*>(packed.data());
  stream.avail_in = static_cast<unsigned>(packed.size());
  ChunkBytes result;
  std::size_t done = 0;
  while (done < most) {
    result.bytes.resize(std::min(most, done + kStep));
    stream.next_out = &result.bytes[done];
    stream.avail_out = static_cast<unsigned>(result.bytes.size() - done);
    const unsigned room = stream.avail_out;
    const int status = BZ2_bzDecompress(&stream);
    done += room - stream.avail_out;
    result.is_whole = status == BZ_STREAM_END;
    if (status != BZ_OK || (stream.avail_in == 0 && stream.avail_out == room)) break;
  }
  result.bytes.resize(done);
  return result;
}

}  // namespace

ChunkBytes decompressChunk(const std::string& compression, const std::string& packed,
                           std::size_t most) {
  if (compression == "lz4") return decompressLz4(packed, most);
  if (compression == "bz2") return decompressBz2(packed, most);
  throw BagDamage("a chunk is compressed by '" + compression + "'; known: lz4, bz2");
}

}  // namespace vins::pipeline
