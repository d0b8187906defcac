#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "camera_model/camera.h"
#include "simulation/image_options.h"
#include "simulation/image_sensor.h"
#include "simulation/scene.h"
#include "simulation/scene_renderer.h"
#include "vins_core/pose.h"

namespace vins::simulation {

/// A camera on a moving body in a scene. Renders its images, and says what is true about them.
/// Neither function changes the object: it may be shared between threads.
class ImageSimulator {
 public:
  using Trajectory = std::function<Pose(double t_s)>;  ///< T_wb at any time

  /// `stream` names the camera's noise: two cameras of one seed need two names. Throws InputError
  /// for bad options.
  ImageSimulator(std::shared_ptr<const Scene> scene,
                 std::shared_ptr<const camera_model::Camera> camera, const Pose& T_bc,
                 const ImageOptions& options, std::uint64_t seed, const std::string& stream);

  const camera_model::Camera& camera() const { return *camera_; }
  const Scene& scene() const { return *scene_; }

  /// The image stamped t_s, CV_8UC1. T_wb is called from this thread only, at times within the
  /// image's exposure. Images of other `frame_index` have other noise.
  cv::Mat render(const Trajectory& T_wb, double t_s, std::uint64_t frame_index) const;

  /// Middle of the exposure of a row (which need not be whole) of the image stamped t_s [s].
  double timeOfRow(double t_s, double row) const;

  /// The point in the world that a pixel sees, for a body at T_wb at t_s. With a rolling shutter,
  /// pose and time are those of the pixel's row: see timeOfRow().
  std::optional<Eigen::Vector3d> pointAt(const Pose& T_wb, const Eigen::Vector2d& pixel,
                                         double t_s) const;

  /// Pixel of a point in the world, or nothing where the camera does not see that direction.
  std::optional<Eigen::Vector2d> project(const Pose& T_wb, const Eigen::Vector3d& p_w) const;

  /// The point lies within the image and nothing hides it. A point that lies on a surface counts
  /// as visible.
  bool isVisible(const Pose& T_wb, const Eigen::Vector3d& p_w, double t_s) const;

 private:
  int exposureSamples(const Trajectory& T_wb, double t_s, double exposure_s) const;
  double pixelMotion(const Pose& T_wb_begin, const Pose& T_wb_end, const Eigen::Vector2d& pixel,
                     double t_s, double exposure_s) const;
  ExposurePlan plan(const Trajectory& T_wb, double t_s) const;

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const camera_model::Camera> camera_;
  Pose T_bc_;
  ImageOptions options_;
  ImageSensor sensor_;
  SceneRenderer renderer_;
};

}  // namespace vins::simulation
