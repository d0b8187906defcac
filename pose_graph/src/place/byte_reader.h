#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "vins_core/input_error.h"

namespace vins {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "files are little-endian");

/// Takes numbers from a file's bytes in turn; never goes past their end.
class ByteReader {
 public:
  /// `name` stands for the file in messages. `bytes` must outlive the reader.
  ByteReader(const std::string& bytes, std::string name) : bytes_(&bytes), name_(std::move(name)) {}

  template <typename Number>
  Number take() {
    Number number;
    std::memcpy(&number, claim(1, sizeof(Number)), sizeof(Number));
    return number;
  }

  /// Memory is given only where the file is long enough.
  template <typename Number>
  std::vector<Number> takeMany(std::size_t count) {
    const char* from = claim(count, sizeof(Number));
    std::vector<Number> numbers(count);
    std::memcpy(numbers.data(), from, count * sizeof(Number));
    return numbers;
  }

  std::size_t left() const { return bytes_->size() - at_; }

  /// Throws InputError: file, place, and what is wrong there.
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_ + ": at byte " + std::to_string(at_) + ": " + what);
  }

 private:
  const char* claim(std::size_t count, std::size_t size) {
    if (count > left() / size) {
      fail("the file ends early; " + std::to_string(count) + " x " + std::to_string(size) +
           " bytes were to come, " + std::to_string(left()) + " are there");
    }
    const char* from = bytes_->data() + at_;
    at_ += count * size;
    return from;
  }

  const std::string* bytes_;
  std::string name_;
  std::size_t at_ = 0;
};

}  // namespace vins
