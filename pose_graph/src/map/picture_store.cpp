#include "pose_graph/map/picture_store.h"

#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace vins::pose_graph {

void PictureStore::add(std::int64_t id, const cv::Mat& image) {
  cv::Mat half;
  cv::resize(image, half, {}, 0.5, 0.5, cv::INTER_AREA);
  std::vector<unsigned char> picture;
  cv::imencode(".jpg", half, picture, {cv::IMWRITE_JPEG_QUALITY, 80});
  addEncoded(id, std::move(picture));
}

void PictureStore::addEncoded(std::int64_t id, std::vector<unsigned char> picture) {
  if (picture.empty()) return;
  pictures_[id] = std::move(picture);
  while (pictures_.size() > count_) pictures_.erase(pictures_.begin());
}

cv::Mat PictureStore::find(std::int64_t id, const cv::Size& size) const {
  const std::vector<unsigned char> picture = encoded(id);
  // A map's picture may be no image: its checksum says only that it was written so.
  const cv::Mat half = picture.empty() ? cv::Mat() : cv::imdecode(picture, cv::IMREAD_GRAYSCALE);
  if (half.empty()) return cv::Mat::zeros(size, CV_8UC1);
  cv::Mat image;
  cv::resize(half, image, size);
  return image;
}

std::vector<unsigned char> PictureStore::encoded(std::int64_t id) const {
  const auto found = pictures_.find(id);
  return found == pictures_.end() ? std::vector<unsigned char>() : found->second;
}

}  // namespace vins::pose_graph
