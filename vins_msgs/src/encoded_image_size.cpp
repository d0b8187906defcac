#include "encoded_image_size.h"

#include <algorithm>
#include <cstddef>

namespace vins_msgs {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A number of `count` bytes, the most significant first.
std::uint32_t numberAt(const Bytes& bytes, std::size_t at, int count) {
  std::uint32_t number = 0;
  for (int i = 0; i < count; ++i) number = (number << 8) | bytes[at + static_cast<std::size_t>(i)];
  return number;
}

std::optional<EncodedImageSize> sizeOfPng(const Bytes& bytes) {
  constexpr std::size_t kSignature = 8, kWidth = 16, kHeight = 20, kEnd = 24;
  const std::uint8_t signature[kSignature] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (bytes.size() < kEnd) return std::nullopt;
  if (!std::equal(signature, signature + kSignature, bytes.begin())) return std::nullopt;
  return EncodedImageSize{numberAt(bytes, kWidth, 4), numberAt(bytes, kHeight, 4)};
}

/// Start of a frame, of any compression: not the tables (C4, CC) and not the extension (C8).
bool isFrameStart(std::uint8_t marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

/// Goes from segment to segment: FF, marker, length, data.
std::optional<EncodedImageSize> sizeOfJpeg(const Bytes& bytes) {
  constexpr std::size_t kFrameHeader = 9;  // marker, length, precision, height, width
  if (bytes.size() < 2 || bytes[0] != 0xff || bytes[1] != 0xd8) return std::nullopt;
  std::size_t at = 2;
  while (at + kFrameHeader <= bytes.size() && bytes[at] == 0xff) {
    if (bytes[at + 1] == 0xff) {  // filling
      ++at;
      continue;
    }
    if (isFrameStart(bytes[at + 1])) {
      return EncodedImageSize{numberAt(bytes, at + 7, 2), numberAt(bytes, at + 5, 2)};
    }
    at += 2 + numberAt(bytes, at + 2, 2);
  }
  return std::nullopt;
}

}  // namespace

std::optional<EncodedImageSize> encodedImageSize(const Bytes& bytes) {
  const auto size = sizeOfPng(bytes);
  return size ? size : sizeOfJpeg(bytes);
}

}  // namespace vins_msgs
