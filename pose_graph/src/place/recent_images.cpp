#include "pose_graph/place/recent_images.h"

#include <cstdlib>

namespace vins::pose_graph {
namespace {

constexpr Stamp kTolerance = 5'000'000;  // [ns]
constexpr Stamp kJump = 1'000'000'000;   // backwards by more, a recording has begun again [ns]

}  // namespace

void RecentImages::add(Stamp stamp, const cv::Mat& image) {
  if (!images_.empty() && stamp <= images_.back().stamp) {
    if (images_.back().stamp - stamp < kJump) return;
    images_.clear();
  }
  images_.push_back({stamp, image});
  while (stamp - images_.front().stamp > span_) images_.pop_front();
}

cv::Mat RecentImages::find(Stamp stamp) const {
  const Entry* nearest = nullptr;
  for (const Entry& entry : images_) {
    const Stamp distance = std::abs(entry.stamp - stamp);
    if (distance > kTolerance) continue;
    if (nearest == nullptr || distance < std::abs(nearest->stamp - stamp)) nearest = &entry;
  }
  return nearest == nullptr ? cv::Mat() : nearest->image;
}

}  // namespace vins::pose_graph
