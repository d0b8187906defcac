#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "bag_records.h"
#include "vins_core/time.h"

namespace vins::pipeline {

/// What a bag says of the messages of one connection.
struct BagConnection {
  std::string topic, type, md5sum;
};

/// Where a message stands in its bag.
struct BagMessage {
  static constexpr std::int32_t kInFile = -1;

  Stamp arrival = 0;             ///< when it was recorded [ns]
  Stamp stamp = 0;               ///< of the header that begins it, where its type has one [ns]
  std::uint64_t offset = 0;      ///< of its first byte, in the file or in the compressed chunk
  std::uint32_t size = 0;        ///< [bytes]
  std::uint32_t connection = 0;  ///< a key of the bag's connections
  std::int32_t chunk = kInFile;  ///< index of the compressed chunk
};

/// Messages behind a bag's damage, as its index tells.
struct BagLoss {
  std::uint32_t connection = 0;
  Stamp begin = 0, end = 0;  ///< of their arrivals [ns]
  std::uint64_t count = 0;
};

/// A ROS bag (version 2.0), found by reading its records one by one as far as they go: with or
/// without an index, whole or cut or damaged, chunks plain or compressed by lz4 or bz2. The file is
/// never changed. Memory: the places of the messages, and a few chunks where they are compressed.
class BagFile {
 public:
  /// Finds all messages. Throws InputError naming the file where it is no such bag.
  explicit BagFile(const std::string& path);

  const std::string& path() const { return path_; }
  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }

  /// In the order of the file; may be called once.
  std::vector<BagMessage> takeMessages() { return std::move(messages_); }

  /// Those that an index behind the damage tells of.
  const std::vector<BagLoss>& lost() const { return lost_; }

  /// False for a recording that was killed: the bag has no index.
  bool isClosed() const { return index_position_ > 0; }

  /// Why the file could not be read to its end; empty where it could. A bag that was not closed
  /// may end within a record.
  const std::string& damage() const { return damage_; }

  /// The message's bytes. Throws InputError where they can no longer be read.
  std::string read(const BagMessage& message);

 private:
  struct Chunk {
    std::uint64_t offset = 0;
    std::uint32_t packed_size = 0;
    std::string compression;
  };

  void readHead(ByteReader* in);
  void scan(ByteReader* in, std::int32_t chunk);
  void scanChunk(const BagRecord& record, ByteReader* in);
  void addConnection(const BagRecord& record, ByteReader* in);
  void addMessage(const BagRecord& record, ByteReader* in, std::int32_t chunk);
  void dropLast();
  void findLost();
  void addLost(const BagRecord& record, ByteReader* in);
  const std::string& bytesOf(std::int32_t chunk);

  std::string path_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  std::uint64_t index_position_ = 0;
  std::uint64_t chunk_position_ = 0;                      ///< of the last chunk's record
  std::map<std::uint32_t, std::uint64_t> read_of_chunk_;  ///< messages of it, by connection
  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<Chunk> chunks_;  ///< the compressed ones
  std::vector<BagMessage> messages_;
  std::vector<BagLoss> lost_;
  std::string damage_;
  std::list<std::pair<std::int32_t, std::string>> cache_;  ///< decompressed, the latest first
};

}  // namespace vins::pipeline
