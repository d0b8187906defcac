#pragma once

#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vins_core/feature_frame.h"
#include "vins_estimator/inertial/measurement_queue.h"

namespace vins::estimator {

/// Options of TimeOffsetSearch.
struct TimeOffsetSearchOptions {
  double max_offset = 0.25;     ///< largest |td| that is looked for [s]
  double step = 2.5e-3;         ///< of the grid of offsets [s]
  double window = 4.0;          ///< of image pairs that are kept [s]
  int min_shared = 12;          ///< features that two images share
  int min_pairs = 12;           ///< of images, for an answer
  double max_sigma = 0.01;      ///< of an answer [s]
  double neighbourhood = 0.04;  ///< offsets nearer than this are one answer [s]
  double min_log_ratio = 3.5;   ///< of the answer's likelihood against that of any other
  double max_misfit = 0.3;      ///< share of the camera's turns that the answer leaves unexplained
};

/// A time offset found by TimeOffsetSearch.
struct TimeOffset {
  double td = 0.0;      ///< t_imu = t_cam + td [s]
  double sigma = 0.0;   ///< deviation [s]
  double misfit = 0.0;  ///< share of the squares of the camera's turns that is left
  int pairs = 0;        ///< of images that were compared
};

/// Finds a time offset of which nothing is known, by comparing how camera and gyroscope turn: the
/// turns of the camera from image to image, taken to the body by R_bc, against the gyroscope's over
/// the same intervals shifted by each offset of a grid; a parabola through the least misfit. The
/// gyroscope's constant bias is fitted along. (The idea of correlating angular rates: E. Mair et
/// al., "Spatio-temporal initialization for IMU to camera registration", ROBIO 2011.)
class TimeOffsetSearch {
 public:
  explicit TimeOffsetSearch(const TimeOffsetSearchOptions& options = {}) : options_(options) {}

  /// Takes the next frame with the samples that lead to it; `R_bc`: camera in the body. Returns the
  /// offset as soon as it is known well enough and no other offset would do; nullopt before.
  std::optional<TimeOffset> addFrame(const FrameMeasurements& measurements,
                                     const Eigen::Quaterniond& R_bc);

  /// Forgets all measurements.
  void clear();

 private:
  /// How the camera turned between two images in a row.
  struct CameraTurn {
    Stamp from = 0, to = 0;                            ///< of the images [ns, the camera's clock]
    Eigen::Vector3d turn_c = Eigen::Vector3d::Zero();  ///< rotation vector, camera frame [rad]
  };
  /// The gyroscope's rate, integrated since the first sample.
  struct Angle {
    Stamp stamp = 0;                                  ///< [ns, the IMU's clock]
    Eigen::Vector3d angle = Eigen::Vector3d::Zero();  ///< [rad]
  };

  void addSamples(const std::vector<ImuSample>& samples);
  void addTurn(const FeatureFrame& frame);
  void forgetOld();
  std::vector<CameraTurn> coveredTurns() const;
  Eigen::Vector3d angleAt(Stamp stamp) const;
  double misfitAt(double td, const std::vector<CameraTurn>& turns,
                  const Eigen::Quaterniond& R_bc) const;
  std::optional<TimeOffset> search(const Eigen::Quaterniond& R_bc) const;
  bool isDistinct(const std::vector<double>& misfits, std::size_t least, std::size_t turns) const;

  TimeOffsetSearchOptions options_;
  std::deque<Angle> angles_;
  std::optional<ImuSample> last_sample_;
  std::optional<FeatureFrame> last_frame_;
  std::deque<CameraTurn> turns_;
};

}  // namespace vins::estimator
