#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <opencv2/core.hpp>

namespace vins::pose_graph {

/// Small copies of keyframes' images, for pictures of loops: half the size, as JPEG, some 10 kB
/// each.
class PictureStore {
 public:
  /// Keeps at most `count` images: those with the highest ids.
  explicit PictureStore(std::size_t count) : count_(count) {}

  /// `image`: CV_8UC1.
  void add(std::int64_t id, const cv::Mat& image);

  /// A picture of a stored map; an empty one is passed over.
  void addEncoded(std::int64_t id, std::vector<unsigned char> picture);

  /// The image in its full size, or a black one of `size` where it is not known. CV_8UC1.
  cv::Mat find(std::int64_t id, const cv::Size& size) const;

  /// The picture as it is kept; empty where it is not known.
  std::vector<unsigned char> encoded(std::int64_t id) const;

  std::size_t size() const { return pictures_.size(); }

 private:
  std::size_t count_;
  std::map<std::int64_t, std::vector<unsigned char>> pictures_;
};

}  // namespace vins::pose_graph
