#include "bag_records.h"

#include <cstring>

namespace vins::pipeline {
namespace {

// Recorders write less than a hundred bytes; a wrong length must not cost memory.
constexpr std::uint32_t kLargestHeader = 1 << 20;

}  // namespace

std::uint32_t uint32At(const char* bytes) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes, sizeof(value));
  return value;
}

Stamp timeAt(const char* bytes) {
  constexpr Stamp kSecond = 1'000'000'000;
  return Stamp{uint32At(bytes)} * kSecond + Stamp{uint32At(bytes + 4)};
}

void ByteReader::require(std::uint64_t size) const {
  if (size <= left()) return;
  throw BagCut("a record of " + std::to_string(size) + " bytes begins " + std::to_string(left()) +
               " bytes before the end");
}

std::string ByteReader::read(std::size_t size) {
  require(size);
  std::string bytes(size, '\0');
  in_->read(bytes.data(), static_cast<std::streamsize>(size));
  if (!*in_) throw BagDamage("byte " + std::to_string(position_) + " cannot be read");
  position_ += size;
  return bytes;
}

std::uint32_t ByteReader::readUint32() { return uint32At(read(sizeof(std::uint32_t)).data()); }

void ByteReader::skip(std::uint64_t size) {
  constexpr std::uint64_t kWorthSeeking = 1 << 16;  // a file's buffer is lost by seeking
  require(size);
  if (size < kWorthSeeking) {
    in_->ignore(static_cast<std::streamsize>(size));
  } else {
    in_->seekg(static_cast<std::streamoff>(size), std::ios::cur);
  }
  position_ += size;
}

BagFields::BagFields(const std::string& bytes) {
  constexpr std::size_t kLength = sizeof(std::uint32_t);
  std::size_t at = 0;
  while (at < bytes.size()) {
    if (bytes.size() - at < kLength) throw BagDamage("a field has no length");
    const std::size_t size = uint32At(&bytes[at]);
    at += kLength;
    if (bytes.size() - at < size) throw BagDamage("a field is longer than its header");
    const std::string field = bytes.substr(at, size);
    at += size;
    const std::size_t equals = field.find('=');
    if (equals == std::string::npos) throw BagDamage("a field has no name");
    fields_.emplace_back(field.substr(0, equals), field.substr(equals + 1));
  }
}

const std::string* BagFields::find(const char* name) const {
  for (const auto& [key, value] : fields_) {
    if (key == name) return &value;
  }
  return nullptr;
}

const std::string& BagFields::text(const char* name) const {
  const std::string* value = find(name);
  if (value == nullptr) throw BagDamage(std::string("a record has no field '") + name + "'");
  return *value;
}

std::uint64_t BagFields::uint64(const char* name) const {
  const std::string& value = text(name);
  if (value.size() != 8) throw BagDamage(std::string("field '") + name + "' has a wrong size");
  return uint32At(value.data()) | (std::uint64_t{uint32At(value.data() + 4)} << 32);
}

std::uint32_t BagFields::uint32(const char* name) const {
  const std::string& value = text(name);
  if (value.size() != 4) throw BagDamage(std::string("field '") + name + "' has a wrong size");
  return uint32At(value.data());
}

std::uint8_t BagFields::uint8(const char* name) const {
  const std::string& value = text(name);
  if (value.size() != 1) throw BagDamage(std::string("field '") + name + "' has a wrong size");
  return static_cast<std::uint8_t>(value[0]);
}

Stamp BagFields::time(const char* name) const {
  uint64(name);  // for its size
  return timeAt(text(name).data());
}

BagRecord readRecord(ByteReader* in) {
  const std::uint32_t size = in->readUint32();
  if (size > kLargestHeader) throw BagDamage("found " + std::to_string(size) + " bytes of header");
  BagFields fields(in->read(size));
  const auto op = static_cast<BagOp>(fields.uint8("op"));
  if (op < BagOp::kMessage || op > BagOp::kConnection) throw BagDamage("a record is of no kind");
  const std::uint32_t data_size = in->readUint32();
  return {op, std::move(fields), data_size};
}

}  // namespace vins::pipeline
