#include "bag_file.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "chunk_bytes.h"
#include "vins_core/input_error.h"

namespace vins::pipeline {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
constexpr std::size_t kLargestChunk = std::size_t{1} << 30;  // [bytes], decompressed

}  // namespace

BagFile::BagFile(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  if (!file_) throw InputError(path + ": cannot be opened");
  size_ = std::filesystem::file_size(path);
  ByteReader in(&file_, size_);
  readHead(&in);
  try {
    scan(&in, BagMessage::kInFile);
    if (index_position_ > size_) {
      throw BagCut("the file has " + std::to_string(size_) + " bytes; its index should stand at " +
                   std::to_string(index_position_));
    }
  } catch (const BagCut& error) {
    if (isClosed()) damage_ = error.what();
  } catch (const BagDamage& error) {
    damage_ = error.what();
    dropLast();
  }
  if (!damage_.empty()) findLost();
}

void BagFile::readHead(ByteReader* in) {
  try {
    if (in->read(sizeof(kMagic) - 1) != kMagic) {
      throw BagDamage(std::string("it does not begin with '") + std::string(kMagic, 12) + "'");
    }
    const BagRecord head = readRecord(in);
    if (head.op != BagOp::kBagHeader) throw BagDamage("its first record is no header");
    index_position_ = head.fields.uint64("index_pos");
    if (head.fields.has("encryptor") && !head.fields.text("encryptor").empty()) {
      throw BagDamage("it is encrypted; run 'rosbag decrypt' on it");
    }
    in->skip(head.data_size);
  } catch (const BagDamage& error) {
    throw InputError(path_ + ": cannot be read as a bag: " + error.what());
  }
}

/// An uncompressed chunk's records are read as if they stood in the file itself; so are those of
/// the chunk that a killed recording left open, whose size is unknown.
void BagFile::scan(ByteReader* in, std::int32_t chunk) {
  const bool is_file = chunk == BagMessage::kInFile;
  while (in->left() > 0) {
    const std::uint64_t position = in->position();
    if (is_file && isClosed() && position >= index_position_) return;
    const BagRecord record = readRecord(in);
    switch (record.op) {
      case BagOp::kMessage:
        addMessage(record, in, chunk);
        break;
      case BagOp::kConnection:
        addConnection(record, in);
        break;
      case BagOp::kChunk:
        if (!is_file) throw BagDamage("a chunk stands within a chunk");
        chunk_position_ = position;
        read_of_chunk_.clear();
        if (record.fields.text("compression") != "none") scanChunk(record, in);
        break;
      default:
        in->skip(record.data_size);
    }
  }
}

void BagFile::scanChunk(const BagRecord& record, ByteReader* in) {
  const bool is_open = record.data_size == 0 && !isClosed();
  if (!is_open) in->require(record.data_size);
  const std::uint64_t size =
      is_open ? std::min<std::uint64_t>(in->left(), kLargestChunk) : record.data_size;
  chunks_.push_back(
      {in->position(), static_cast<std::uint32_t>(size), record.fields.text("compression")});
  const auto packed = in->read(size);
  const ChunkBytes unpacked = decompressChunk(chunks_.back().compression, packed, kLargestChunk);
  std::istringstream bytes(unpacked.bytes);
  ByteReader within(&bytes, unpacked.bytes.size());
  scan(&within, static_cast<std::int32_t>(chunks_.size()) - 1);
  if (unpacked.is_whole) return;
  if (is_open) throw BagCut("the last chunk has no end");
  throw BagDamage("a chunk cannot be decompressed (" + chunks_.back().compression + ")");
}

void BagFile::addConnection(const BagRecord& record, ByteReader* in) {
  in->require(record.data_size);
  const BagFields fields(in->read(record.data_size));
  connections_[record.fields.uint32("conn")] = {record.fields.text("topic"), fields.text("type"),
                                                fields.text("md5sum")};
}

void BagFile::addMessage(const BagRecord& record, ByteReader* in, std::int32_t chunk) {
  constexpr std::uint32_t kHeaderStart = 12;  // sequence number, then the stamp
  BagMessage message;
  message.connection = record.fields.uint32("conn");
  if (connections_.count(message.connection) == 0) throw BagDamage("a message has no connection");
  message.arrival = record.fields.time("time");
  message.offset = in->position();
  message.size = record.data_size;
  message.chunk = chunk;
  in->require(message.size);
  if (message.size >= kHeaderStart) {
    message.stamp = timeAt(in->read(kHeaderStart).data() + 4);
    in->skip(message.size - kHeaderStart);
  } else {
    in->skip(message.size);
  }
  messages_.push_back(message);
  ++read_of_chunk_[message.connection];
}

/// The damage may begin within the message before it in the same chunk.
void BagFile::dropLast() {
  if (messages_.empty()) return;
  std::uint64_t& read = read_of_chunk_[messages_.back().connection];
  if (read == 0) return;
  --read;
  messages_.pop_back();
}

void BagFile::findLost() {
  if (!isClosed() || index_position_ >= size_) return;
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(index_position_));
  ByteReader in(&file_, size_ - index_position_);
  try {
    while (in.left() > 0) {
      const BagRecord record = readRecord(&in);
      if (record.op == BagOp::kConnection) {
        addConnection(record, &in);
      } else if (record.op == BagOp::kChunkInfo) {
        addLost(record, &in);
      } else {
        in.skip(record.data_size);
      }
    }
  } catch (const BagDamage&) {
    // What a damaged index tells up to its own damage is all that is known.
  }
}

void BagFile::addLost(const BagRecord& record, ByteReader* in) {
  in->require(record.data_size);
  const std::string counts = in->read(record.data_size);
  const std::uint64_t position = record.fields.uint64("chunk_pos");
  if (position < chunk_position_) return;
  constexpr std::size_t kPair = 8;  // connection, then count
  for (std::size_t at = 0; at + kPair <= counts.size(); at += kPair) {
    BagLoss loss{uint32At(&counts[at]), record.fields.time("start_time"),
                 record.fields.time("end_time"), uint32At(&counts[at + 4])};
    const auto read = read_of_chunk_.find(loss.connection);
    if (position == chunk_position_ && read != read_of_chunk_.end()) {
      loss.count -= std::min(loss.count, read->second);
    }
    if (loss.count > 0) lost_.push_back(loss);
  }
}

const std::string& BagFile::bytesOf(std::int32_t chunk) {
  constexpr std::size_t kMost = 4;  // messages are used in almost the order of the file
  const auto known = std::find_if(cache_.begin(), cache_.end(),
                                  [chunk](const auto& entry) { return entry.first == chunk; });
  if (known != cache_.end()) {
    cache_.splice(cache_.begin(), cache_, known);
    return cache_.front().second;
  }
  const Chunk& place = chunks_[static_cast<std::size_t>(chunk)];
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(place.offset));
  ByteReader in(&file_, place.packed_size);
  const std::string packed = in.read(place.packed_size);
  cache_.emplace_front(chunk, decompressChunk(place.compression, packed, kLargestChunk).bytes);
  if (cache_.size() > kMost) cache_.pop_back();
  return cache_.front().second;
}

std::string BagFile::read(const BagMessage& message) {
  try {
    if (message.chunk != BagMessage::kInFile) {
      const std::string& chunk = bytesOf(message.chunk);
      if (message.offset + message.size > chunk.size()) throw BagDamage("a chunk has changed");
      return chunk.substr(message.offset, message.size);
    }
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(message.offset));
    return ByteReader(&file_, message.size).read(message.size);
  } catch (const BagDamage& error) {
    throw InputError(path_ + ": byte " + std::to_string(message.offset) +
                     " can no longer be read: " + error.what());
  }
}

}  // namespace vins::pipeline
