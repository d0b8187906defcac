#include "town_walk.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pose_graph/place/vocabulary_training.h"
#include "vins_core/heading.h"
#include "vins_core/so3.h"

namespace vins::pose_graph {
namespace {

constexpr double kPixelAngle = 1.0 / 460.0;  // [rad]
constexpr double kNear = 4.0, kFar = 26.0;   // along the road, where landmarks are seen [m]
constexpr double kHalfAngle = 0.65;          // of the camera's cone [rad]

Pose cameraInBody() {
  // Camera z along body x, camera y down.
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Eigen::Quaterniond(R), {0.05, 0.02, -0.01}};
}

double uniform(std::mt19937_64* random, double from, double to) {
  return from + (to - from) * static_cast<double>((*random)() >> 11) * 0x1.0p-53;
}

/// Of the landmarks' descriptors, as many in a row as an image.
PlaceModel train(const std::vector<BriefDescriptor>& descriptors, std::size_t in_image) {
  std::vector<std::vector<BriefDescriptor>> images;
  for (std::size_t i = 0; i < descriptors.size(); i += in_image) {
    const std::size_t end = std::min(i + in_image, descriptors.size());
    images.emplace_back(descriptors.begin() + static_cast<std::ptrdiff_t>(i),
                        descriptors.begin() + static_cast<std::ptrdiff_t>(end));
  }
  PlaceModel places;
  places.vocabulary = std::make_shared<const Vocabulary>(trainVocabulary(images, {}));
  places.pattern = std::make_shared<const BriefPattern>(BriefPattern::generate(1, 49));
  return places;
}

}  // namespace

TownWalk::TownWalk(const TownWalkOptions& options) : options_(options), random_(options.seed) {
  const auto count = static_cast<std::size_t>(options.lap * options.landmarks);
  std::vector<BriefDescriptor> descriptors;
  for (std::size_t i = 0; i < count; ++i) {
    const double distance = options.lap * static_cast<double>(i) / static_cast<double>(count);
    const double side = (i % 2 == 0 ? 1.0 : -1.0) * uniform(&random_, 3.0, 8.0);
    const double height = uniform(&random_, -1.0, 5.0);
    BriefDescriptor descriptor;
    for (auto& word : descriptor) word = random_();
    landmarks_.push_back({truthAt(distance) * Eigen::Vector3d(0.0, side, height), descriptor});
    descriptors.push_back(descriptor);
  }
  places_ = train(descriptors, static_cast<std::size_t>(20.0 * options.landmarks));
}

Pose TownWalk::truthAt(double distance) const {
  const double radius = options_.lap / (2.0 * M_PI), angle = distance / radius;
  return {yawRotation(angle + M_PI / 2.0), {radius * std::cos(angle), radius * std::sin(angle), 0}};
}

double TownWalk::normal(double sigma) {
  // Box and Muller: the standard library's distributions differ from computer to computer.
  const double u = uniform(&random_, 1e-12, 1.0), v = uniform(&random_, 0.0, 2.0 * M_PI);
  return sigma * std::sqrt(-2.0 * std::log(u)) * std::cos(v);
}

BriefDescriptor TownWalk::seen(BriefDescriptor descriptor) {
  for (int i = 0; i < options_.descriptor_noise; ++i) {
    const std::uint64_t bit = random_() % kDescriptorBits;
    descriptor[bit / 64] ^= std::uint64_t{1} << (bit % 64);
  }
  return descriptor;
}

void TownWalk::addFeature(std::size_t landmark, const Eigen::Vector3d& p_b, KeyframeView* view) {
  const Eigen::Vector3d p_c = view->T_bc.inverse() * p_b;
  Eigen::Vector3d bearing = p_c.normalized();
  const Eigen::Vector3d side = bearing.unitOrthogonal();
  const double sigma = options_.pixel_noise * kPixelAngle;
  bearing += normal(sigma) * side + normal(sigma) * bearing.cross(side);
  ViewFeature feature;
  feature.descriptor = seen(landmarks_[landmark].descriptor);
  feature.bearing = bearing.normalized().cast<float>();
  feature.pixel = (bearing.head<2>() / bearing.z() / kPixelAngle).cast<float>();
  if (view->points.size() < options_.points && landmark / 2 % 4 == 0) {
    feature.point = static_cast<std::int32_t>(view->points.size());
    view->points.push_back(
        {static_cast<std::int64_t>(landmark), p_b * (1.0 + normal(options_.depth_noise))});
  }
  view->features.push_back(feature);
}

KeyframeView TownWalk::viewFrom(const Pose& T_tb, double distance) {
  KeyframeView view;
  view.id = next_id_;
  view.T_bc = cameraInBody();
  view.pixel_angle = kPixelAngle;
  const Pose T_bt = T_tb.inverse();
  const auto first = static_cast<std::size_t>((distance + kNear) * options_.landmarks);
  const auto last = static_cast<std::size_t>((distance + kFar) * options_.landmarks);
  for (std::size_t i = first; i < last; ++i) {
    const Eigen::Vector3d p_b = T_bt * landmarks_[i % landmarks_.size()].position;
    const Eigen::Vector3d p_c = view.T_bc.inverse() * p_b;
    if (p_c.z() < std::cos(kHalfAngle) * p_c.norm()) continue;
    addFeature(i % landmarks_.size(), p_b, &view);
  }
  return view;
}

void TownWalk::drift() {
  const double root = std::sqrt(options_.period);
  const double sigma = options_.position_drift * root;
  const Eigen::Vector3d slip(normal(sigma), normal(sigma), normal(sigma));
  T_wt_ = Pose(yawRotation(normal(options_.yaw_drift * root)), slip) * T_wt_;
}

TownKeyframe TownWalk::next() {
  const double time = options_.period * static_cast<double>(next_id_);
  const double distance = options_.speed * time;
  const Pose sway(
      yawRotation(0.05 * std::sin(0.11 * time)) *
          so3::exp({0.02 * std::sin(time), 0.02 * std::cos(0.7 * time), 0.0}),
      {0.0, options_.sway * std::sin(0.013 * time), options_.sway / 6.0 * std::sin(0.9 * time)});
  if (next_id_ > 0) drift();
  TownKeyframe result;
  result.truth = truthAt(distance) * sway;
  result.described.view = viewFrom(result.truth, distance);
  Keyframe& keyframe = result.keyframe;
  keyframe.id = next_id_++;
  keyframe.stamp = toNanoseconds(time) + 1;
  keyframe.T_wb = T_wt_ * result.truth;
  keyframe.T_bc = result.described.view.T_bc;
  KeyframeView& view = result.described.view;
  view.R_wb = keyframe.T_wb.rotation;
  std::vector<BriefDescriptor> descriptors;
  for (const ViewFeature& feature : view.features) descriptors.push_back(feature.descriptor);
  result.described.bag = places_.vocabulary->describe(descriptors, 0).bag;
  return result;
}

}  // namespace vins::pose_graph
