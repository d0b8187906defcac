#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vins_core/time.h"

// The records that a ROS bag of version 2.0 consists of (wiki.ros.org/Bags/Format/2.0).

namespace vins::pipeline {

/// What the bytes of a bag should not be.
class BagDamage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A record goes on beyond the end of the bytes.
class BagCut : public BagDamage {
 public:
  using BagDamage::BagDamage;
};

/// Reads bytes of which the number is known; never beyond it.
class ByteReader {
 public:
  /// `in` stands at the first of `size` bytes, can seek, and must live as long as the reader.
  ByteReader(std::istream* in, std::uint64_t size) : in_(in), size_(size) {}

  std::uint64_t position() const { return position_; }
  std::uint64_t left() const { return size_ - position_; }

  /// Throws BagCut where fewer than `size` bytes are left.
  void require(std::uint64_t size) const;
  std::string read(std::size_t size);
  std::uint32_t readUint32();
  void skip(std::uint64_t size);

 private:
  std::istream* in_;
  std::uint64_t size_, position_ = 0;
};

/// Kinds of records, by their field `op`.
enum class BagOp : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

/// Fields `name=value`, each behind its length. Values are of any bytes.
class BagFields {
 public:
  /// Throws BagDamage where `bytes` are no fields.
  explicit BagFields(const std::string& bytes);

  /// Throws BagDamage where the field is missing or has another size than the type.
  std::uint8_t uint8(const char* name) const;
  std::uint32_t uint32(const char* name) const;
  std::uint64_t uint64(const char* name) const;
  Stamp time(const char* name) const;  ///< [ns]

  /// Throws BagDamage where the field is missing.
  const std::string& text(const char* name) const;

  bool has(const char* name) const { return find(name) != nullptr; }

 private:
  const std::string* find(const char* name) const;

  std::vector<std::pair<std::string, std::string>> fields_;
};

/// The head of a record; `data_size` bytes of data follow.
struct BagRecord {
  BagOp op = BagOp::kMessage;
  BagFields fields;
  std::uint32_t data_size = 0;
};

/// Reads up to the record's data. Throws BagDamage where there is no record.
BagRecord readRecord(ByteReader* in);

/// The number that begins `bytes` (little-endian), which must be long enough.
std::uint32_t uint32At(const char* bytes);

/// A time as ROS writes it: seconds, then nanoseconds [ns].
Stamp timeAt(const char* bytes);

}  // namespace vins::pipeline
