#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "simulation/auto_exposure.h"
#include "simulation/faults.h"
#include "simulation/frame_timing.h"
#include "simulation/image_simulator.h"
#include "simulation/imu_simulator.h"
#include "simulation/rig.h"
#include "simulation/trajectory_spline.h"
#include "vins_core/trajectory.h"

namespace vins::simulation {

/// A rig that is not EuRoC's: what it is, what its user believes, and what its IMU does.
struct OwnRig {
  Rig truth;
  Rig handed_out;
  ImuOptions imu;
};

/// A recording to simulate.
struct RecordingOptions {
  std::string trajectory = "hall_loop";  ///< name of a built-in one, or a file of poses
  std::string scene;                     ///< of sceneNames(), fitted_room or fitted_hall; or empty:
                                         ///< the built-in trajectory's own, or a fitted one
  double start = 0.0;                    ///< of the recording in the trajectory [s]
  std::optional<double> duration;        ///< [s]; 60, or to the end of a file
  std::uint64_t seed = 1;
  std::string camera_file;  ///< empty: EuRoC's cameras
  bool stereo = false;
  double image_rate = 20.0;             ///< [Hz]
  double imu_rate = 200.0;              ///< [Hz]
  std::string imu_noise = "euroc";      ///< euroc, low (a tenth of it) or none
  double vibration = 0.0;               ///< of the rotors at 90 Hz, root mean square [m/s^2]
  std::vector<ImuSample> recorded_imu;  ///< taken in place of a simulated IMU where not empty
  double time_offset = 0.0;             ///< td [s]
  double calibration_error = 0.0;       ///< of the rig as handed out [sigmas]
  int moving_objects = 0;
  Faults faults;
  FrameTiming timing;                         ///< its rate is ignored: see `image_rate`
  std::optional<AutoExposure> auto_exposure;  ///< in place of the image's exposure
  std::optional<OwnRig> own_rig;              ///< in place of EuRoC's rig and its options above
  ImageOptions image;                         ///< its blackouts are ignored: see `faults`

  /// Throws InputError naming the value that is out of range.
  void validate() const;
};

/// A recording whose images are rendered on demand. Stamps of images and of the ground truth are of
/// the camera's clock.
struct SimulatedRecording {
  TrajectorySpline motion;
  std::vector<Stamp> image_stamps;
  std::vector<double> image_times;  ///< when each image is really taken [s of the motion]
  std::vector<ArrivedSample> imu;
  std::vector<ImuBias> biases;  ///< in the samples; empty where the IMU is recorded
  Trajectory ground_truth;      ///< body poses at 200 Hz
  Rig true_rig;
  Rig rig;                  ///< as handed out
  std::string description;  ///< of the choices made, for people; a line each
  std::vector<ImageSimulator> cameras;

  /// Image `index` of a camera, CV_8UC1.
  cv::Mat render(std::size_t camera, std::size_t index) const;
};

/// Throws InputError for bad options, unreadable files and spans that the trajectory does not
/// cover.
SimulatedRecording simulateRecording(const RecordingOptions& options);

/// The true biases as text: stamp [ns] (IMU's clock), accelerometer [m/s^2], gyroscope [rad/s].
std::string toText(const std::vector<ImuBias>& biases);

}  // namespace vins::simulation
