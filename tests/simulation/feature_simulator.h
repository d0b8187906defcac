#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <ostream>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "camera_model/camera.h"
#include "simulation/random.h"
#include "simulation/trajectory_spline.h"
#include "vins_core/feature_frame.h"
#include "vins_core/pose.h"

namespace vins::simulation {

/// What a feature tracker without images sees, and how well.
struct FeatureSimulatorOptions {
  double start = 0.0;        ///< of the first frame, in seconds of the motion [s]
  double duration = 60.0;    ///< from the first frame to the last [s]
  double image_rate = 20.0;  ///< [Hz]
  double readout = 0.0;      ///< of a rolling shutter, from the first row to the last [s]

  int max_features = 150;           ///< tracks per frame
  double min_distance = 30.0;       ///< between tracks where one starts [px]
  double border = 8.0;              ///< no track is nearer to the image's edge [px]
  double pixel_noise = 0.5;         ///< deviation per axis, without memory [px]
  double loss_probability = 0.02;   ///< of a track, from one frame to the next
  double outlier_ratio = 0.0;       ///< share of observations that are anywhere nearby
  double outlier_deviation = 20.0;  ///< of these, per axis [px]

  int landmarks = 6000;           ///< in the room
  double clutter = 0.3;           ///< share of them that hang in the room, not on its walls
  double margin = 3.0;            ///< from the trajectory's extent to the walls [m]
  double min_depth = 0.4;         ///< landmarks nearer than that are not seen [m]
  double moving_fraction = 0.0;   ///< share of landmarks that swing to and fro
  double moving_amplitude = 1.0;  ///< of their swing, which takes 4 to 10 s [m]

  std::uint64_t seed = 1;

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

std::ostream& operator<<(std::ostream& out, const FeatureSimulatorOptions& options);

/// Landmarks on the walls and in the free space of a box around a trajectory, seen by a camera on
/// it: feature frames without images, thousands a second. A track keeps its id as long as it is
/// seen; new ones start where the image is empty. The same seed gives the same frames; noise,
/// losses and landmarks are random streams of their own.
class FeatureSimulator {
 public:
  /// Throws InputError for bad options and where the motion does not reach over the frames.
  FeatureSimulator(TrajectorySpline motion, std::shared_ptr<const camera_model::Camera> camera,
                   const Pose& T_bc, const FeatureSimulatorOptions& options);

  /// The next frame, stamped in the camera's clock; nothing after the last.
  std::optional<FeatureFrame> next();

  /// All frames that are left.
  std::vector<FeatureFrame> rest();

  /// Where the landmark of a track is at a stamp, nothing for an unknown id [m].
  std::optional<Eigen::Vector3d> positionOf(std::int64_t id, Stamp stamp) const;

  /// The walls.
  const Eigen::AlignedBox3d& room() const { return room_; }

 private:
  struct Landmark {
    Eigen::Vector3d position_w;                         ///< where it is, or swings about [m]
    Eigen::Vector3d swing_w = Eigen::Vector3d::Zero();  ///< [m]
    double frequency = 0.0;                             ///< of the swing [rad/s]
    double phase = 0.0;                                 ///< [rad]

    Eigen::Vector3d at(double t_s) const;
  };
  struct Track {
    std::int64_t id;
    std::size_t landmark;
    int length;
    Eigen::Vector3d bearing;  ///< as measured last
  };
  struct View;

  void makeRoom();
  void makeLandmarks();
  /// True pixels of all landmarks that the camera sees.
  View look(double t_s) const;
  /// Where a point in the camera's frame is seen; nothing where it is out of view.
  std::optional<Eigen::Vector2d> pixelOf(const Eigen::Vector3d& p_c) const;
  /// Where a landmark is seen when its own row is exposed; at `t_s`, the first row's time, it would
  /// be at `first_row`.
  std::optional<Eigen::Vector2d> pixelInItsRow(const Landmark& landmark, double t_s,
                                               const Eigen::Vector2d& first_row) const;
  Eigen::Vector2d measure(const Eigen::Vector2d& true_pixel);
  std::optional<FeatureObservation> observe(const View& view, Track* track);
  void continueTracks(const View& view, FeatureFrame* frame);
  /// Landmarks in view without a track, in random order.
  std::vector<std::size_t> candidates(const View& view);
  void startTracks(const View& view, FeatureFrame* frame);

  TrajectorySpline motion_;
  std::shared_ptr<const camera_model::Camera> camera_;
  Pose T_bc_;
  FeatureSimulatorOptions options_;
  double widest_cosine_ = -1.0;  ///< of the angles from the optical axis within the image
  Eigen::AlignedBox3d room_;
  std::vector<Landmark> landmarks_;
  std::vector<Track> tracks_;
  std::vector<std::size_t> landmark_of_id_;  ///< ids count from 0
  Random noise_;
  Random losses_;
  Random outliers_;
  Random starts_;
  std::uint32_t frame_ = 0;
};

}  // namespace vins::simulation
