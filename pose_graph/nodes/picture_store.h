#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <opencv2/core.hpp>

namespace vins {

/// Small copies of keyframes' images, for pictures of loops: half the size, as JPEG, some 10 kB
/// each.
class PictureStore {
 public:
  /// Keeps at most `count` images: those with the highest ids.
  explicit PictureStore(std::size_t count) : count_(count) {}

  /// `image`: CV_8UC1.
  void add(std::int64_t id, const cv::Mat& image);

  /// The image in its full size, or a black one of `size` where it is not known. CV_8UC1.
  cv::Mat find(std::int64_t id, const cv::Size& size) const;

 private:
  std::size_t count_;
  std::map<std::int64_t, std::vector<unsigned char>> pictures_;
};

}  // namespace vins
