#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace vins_msgs {

/// Columns and rows of an image.
struct EncodedImageSize {
  std::uint32_t width = 0, height = 0;
};

/// The size that the header of a JPEG or PNG file tells; nothing where it is neither.
std::optional<EncodedImageSize> encodedImageSize(const std::vector<std::uint8_t>& bytes);

}  // namespace vins_msgs
