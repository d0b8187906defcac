#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "camera_model/camera.h"
#include "pose_graph/place/brief.h"
#include "pose_graph/place/spread_corners.h"
#include "pose_graph/place/vocabulary.h"
#include "vins_core/keyframe.h"

namespace vins::pose_graph {

/// A described corner of a keyframe's image.
struct ViewFeature {
  BriefDescriptor descriptor{};
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();     ///< [px]
  Eigen::Vector3f bearing = Eigen::Vector3f::UnitZ();  ///< unit vector in the camera frame
  std::uint32_t node = 0;   ///< of the vocabulary, at the level of the direct index
  std::int32_t point = -1;  ///< index in KeyframeView::points; -1 for a corner without a depth
};

/// A landmark of the estimator's window, seen from the body.
struct ViewPoint {
  std::int64_t id = 0;                                   ///< of the feature track
  Eigen::Vector3d position_b = Eigen::Vector3d::Zero();  ///< in the keyframe's body frame [m]
};

/// What is kept of a keyframe's image, so that its place can be told again: some 40 kB.
struct KeyframeView {
  std::int64_t id = 0;  ///< the keyframe's
  /// Body in a frame whose z axis is upwards. Only roll and pitch are used, which the odometry does
  /// not lose: the pose graph need not correct it.
  Eigen::Quaterniond R_wb = Eigen::Quaterniond::Identity();
  Pose T_bc;                          ///< camera in the body frame
  double pixel_angle = 1.0 / 460.0;   ///< that a pixel spans at the image's centre [rad/px]
  std::vector<ViewFeature> features;  ///< by rising node: this is the direct index
  std::vector<ViewPoint> points;

  /// Bytes that it takes.
  std::size_t memory() const;
};

/// How views are made.
struct ViewOptions {
  SpreadCornersOptions corners;  ///< the border is at least the descriptor's
  /// Level of the tree at which features are compared with those of the same node only; 0: with
  /// all. D. Galvez-Lopez, J. D. Tardos, T-RO 2012, section III-B.
  int direct_index_level = 0;

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// A view and the bag of words by which it is found.
struct DescribedView {
  KeyframeView view;
  BagOfWords bag;
};

/// Makes views of keyframes and their images.
class ViewDescriber {
 public:
  /// `camera` and `vocabulary` must outlive it.
  ViewDescriber(const camera_model::Camera& camera, const Vocabulary& vocabulary,
                const BriefPattern& pattern, const ViewOptions& options);

  /// Describes the keyframe's points where the image (CV_8UC1) shows them, and some hundred corners
  /// besides. Throws InputError where the image's type or size is not the camera's.
  DescribedView describe(const Keyframe& keyframe, const cv::Mat& image) const;

  /// Finds the words of a view's features: sets their nodes, sorts them by these, and returns the
  /// bag.
  BagOfWords findWords(KeyframeView* view) const;

 private:
  /// Bearings of extra corners; those without one are left out.
  void addCorners(const cv::Mat& image, std::vector<cv::Point2f>* pixels,
                  std::vector<ViewFeature>* features) const;

  const camera_model::Camera* camera_;
  const Vocabulary* vocabulary_;
  BriefExtractor brief_;
  ViewOptions options_;
  double pixel_angle_;
};

}  // namespace vins::pose_graph
