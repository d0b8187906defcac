#include "pose_graph/place/keyframe_view.h"

#include <algorithm>
#include <cmath>

#include "vins_core/input_error.h"
#include "vins_core/option_check.h"

namespace vins::pose_graph {
namespace {

/// The angle between the bearings of pixels on either side of the image's centre.
double pixelAngleOf(const camera_model::Camera& camera) {
  const camera_model::ImageSize size = camera.imageSize();
  const Eigen::Vector2d centre(0.5 * size.width, 0.5 * size.height);
  const auto left = camera.unproject(centre - Eigen::Vector2d(5.0, 0.0));
  const auto right = camera.unproject(centre + Eigen::Vector2d(5.0, 0.0));
  if (!left || !right) throw InputError(camera.name() + ": has no bearing at the image's centre");
  return left->cross(*right).norm() / 10.0;
}

ViewFeature featureOf(const Eigen::Vector2d& pixel, const Eigen::Vector3d& bearing, int point) {
  ViewFeature feature;
  feature.pixel = pixel.cast<float>();
  feature.bearing = bearing.cast<float>().normalized();
  feature.point = point;
  return feature;
}

cv::Point2f toPoint(const Eigen::Vector2d& pixel) {
  return {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
}

}  // namespace

std::size_t KeyframeView::memory() const {
  return sizeof(*this) + features.capacity() * sizeof(ViewFeature) +
         points.capacity() * sizeof(ViewPoint);
}

void ViewOptions::validate() const {
  corners.validate();
  requireWithin("keyframe view", "direct_index_level", direct_index_level, {0, 10});
}

ViewDescriber::ViewDescriber(const camera_model::Camera& camera, const Vocabulary& vocabulary,
                             const BriefPattern& pattern, const ViewOptions& options)
    : camera_(&camera),
      vocabulary_(&vocabulary),
      brief_(pattern),
      options_(options),
      pixel_angle_(pixelAngleOf(camera)) {
  options_.validate();
  options_.corners.border = std::max(options_.corners.border, brief_.border());
}

void ViewDescriber::addCorners(const cv::Mat& image, std::vector<cv::Point2f>* pixels,
                               std::vector<ViewFeature>* features) const {
  for (const cv::Point2f& corner : findSpreadCorners(image, *pixels, options_.corners)) {
    const Eigen::Vector2d pixel(corner.x, corner.y);
    const auto bearing = camera_->unproject(pixel);
    if (!bearing) continue;
    pixels->push_back(corner);
    features->push_back(featureOf(pixel, *bearing, -1));
  }
}

DescribedView ViewDescriber::describe(const Keyframe& keyframe, const cv::Mat& image) const {
  const camera_model::ImageSize size = camera_->imageSize();
  if (image.cols != size.width || image.rows != size.height) {
    throw InputError("keyframe view: the image has " + std::to_string(image.cols) + "x" +
                     std::to_string(image.rows) + " pixels, the camera " +
                     std::to_string(size.width) + "x" + std::to_string(size.height));
  }
  DescribedView result;
  KeyframeView& view = result.view;
  view.id = keyframe.id;
  view.R_wb = keyframe.T_wb.rotation;
  view.T_bc = keyframe.T_bc;
  view.pixel_angle = pixel_angle_;
  const Pose T_bw = keyframe.T_wb.inverse();
  std::vector<cv::Point2f> pixels;
  std::vector<ViewFeature> features;
  for (const KeyframePoint& point : keyframe.points) {
    features.push_back(featureOf(point.pixel, point.bearing, static_cast<int>(view.points.size())));
    pixels.push_back(toPoint(point.pixel));
    view.points.push_back({point.id, T_bw * point.position_w});
  }
  addCorners(image, &pixels, &features);
  const DescribedPixels described = brief_.describe(image, pixels);
  view.features.reserve(described.indices.size());
  for (std::size_t i = 0; i < described.indices.size(); ++i) {
    ViewFeature feature = features[described.indices[i]];
    feature.descriptor = described.descriptors[i];
    view.features.push_back(feature);
  }
  result.bag = findWords(&view);
  return result;
}

BagOfWords ViewDescriber::findWords(KeyframeView* view) const {
  std::vector<BriefDescriptor> descriptors;
  descriptors.reserve(view->features.size());
  for (const ViewFeature& feature : view->features) descriptors.push_back(feature.descriptor);
  ImageWords words = vocabulary_->describe(descriptors, options_.direct_index_level);
  for (std::size_t i = 0; i < descriptors.size(); ++i) view->features[i].node = words.nodes[i];
  std::stable_sort(view->features.begin(), view->features.end(),
                   [](const auto& a, const auto& b) { return a.node < b.node; });
  return std::move(words.bag);
}

}  // namespace vins::pose_graph
