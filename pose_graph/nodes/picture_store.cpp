#include "picture_store.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace vins {

void PictureStore::add(std::int64_t id, const cv::Mat& image) {
  cv::Mat half;
  cv::resize(image, half, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::imencode(".jpg", half, pictures_[id], {cv::IMWRITE_JPEG_QUALITY, 80});
  while (pictures_.size() > count_) pictures_.erase(pictures_.begin());
}

cv::Mat PictureStore::find(std::int64_t id, const cv::Size& size) const {
  const auto found = pictures_.find(id);
  if (found == pictures_.end()) return cv::Mat::zeros(size, CV_8UC1);
  cv::Mat image;
  cv::resize(cv::imdecode(found->second, cv::IMREAD_GRAYSCALE), image, size);
  return image;
}

}  // namespace vins
