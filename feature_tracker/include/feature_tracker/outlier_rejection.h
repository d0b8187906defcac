#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace vins::feature_tracker {

/// One point seen by a camera at two times.
struct BearingPair {
  Eigen::Vector3d first = Eigen::Vector3d::UnitZ();   ///< unit bearing, then
  Eigen::Vector3d second = Eigen::Vector3d::UnitZ();  ///< unit bearing, now
  double angular_resolution = 1.0 / 460.0;            ///< of a pixel at `second` [rad/px]
};

/// How the camera moved: p_2 = R_21 p_1 + s t_21 for points in the camera frames 1 (then) and 2
/// (now), with an unknown s >= 0.
struct RelativeMotion {
  Eigen::Quaterniond R_21 = Eigen::Quaterniond::Identity();
  Eigen::Vector3d t_21 = Eigen::Vector3d::UnitZ();  ///< unit vector
};

/// Distance of the second bearing from the epipolar plane of the first [px]. Near the epipole,
/// where any plane will do, it fades to zero.
double epipolarDistance(const BearingPair& pair, const RelativeMotion& motion);

/// How far the second bearing lies from where the first one is turned to [px]: the parallax.
double parallax(const BearingPair& pair, const Eigen::Quaterniond& R_21);

/// The second bearing's distance along the epipolar plane from where a point at infinity would be
/// [px]: positive for points in front of the camera.
double displacement(const BearingPair& pair, const RelativeMotion& motion);

class EpipolarTable;

/// What OutlierRejection goes by.
struct OutlierRejectionOptions {
  /// Distance to the epipolar plane that is allowed at most [px]; less, down to 0.3 of it, where
  /// most pairs agree better: 5 standard deviations by their median.
  double threshold = 1.0;
  double rotation_sigma = 2e-3;  ///< standard deviation of a measured rotation [rad]
  int samples = 50;              ///< random samples per pair of images
  std::uint64_t seed = 1;
};

/// Which of the pairs a single motion of the camera explains.
struct RejectionResult {
  std::vector<std::uint8_t> is_inlier;  ///< 1 or 0 for each pair
  int inliers = 0;
  double threshold = 0.0;  ///< that was applied [px]
  RelativeMotion motion;
};

/// Tells tracks of the still world from wrong matches and moving objects, on unit bearings: cameras
/// of any field of view are served alike.
///
/// Random samples of five pairs are fitted by Gauss-Newton steps on rotation and direction (T.
/// Botterill, S. Mills, R. Green, "Fast RANSAC hypothesis generation for essential matrix
/// estimation", DICTA 2011), which begin at the measured rotation and are bound to it as tightly as
/// it is known; without one, or where that explains less than half of the pairs, at a rotation
/// fitted to all pairs. The best are fitted to all pairs robustly, the rotation too: the
/// gyroscope's bias would else cost good tracks.
///
/// The motion whose median distance is the least wins (P. Rousseeuw, "Least median of squares
/// regression", 1984): the one that more than half of the pairs agree on as closely as tracks can.
/// No fixed threshold would do. Where the camera moves by centimetres, the still world's parallax
/// is less than a pixel, and a motion that is bent towards an object's explains both within that;
/// the tracks' own noise is a tenth of it. Where nothing has parallax the direction means nothing,
/// and pairs are judged by the rotation, which every direction is consistent with.
class OutlierRejection {
 public:
  explicit OutlierRejection(const OutlierRejectionOptions& options);
  ~OutlierRejection();

  /// `R_21_measured`: rotation by the gyroscope, if known. `R_21_guess` is where the search starts
  /// otherwise. Fewer than 6 pairs cannot be judged: all are inliers then. The same calls after
  /// the same seed give the same answers.
  RejectionResult reject(const std::vector<BearingPair>& pairs,
                         const std::optional<Eigen::Quaterniond>& R_21_measured,
                         const Eigen::Quaterniond& R_21_guess = Eigen::Quaterniond::Identity());

 private:
  struct MotionSearch;
  struct Candidate;

  std::vector<Candidate> propose(const std::vector<BearingPair>& pairs, const MotionSearch& search);
  RelativeMotion search(const std::vector<BearingPair>& pairs, const MotionSearch& search);
  RelativeMotion polish(const std::vector<BearingPair>& pairs, RelativeMotion motion,
                        const MotionSearch& search, int steps);
  /// Infinite where it is beyond the limit.
  double medianDistance(const RelativeMotion& motion, double limit);
  RejectionResult classify(const std::vector<BearingPair>& pairs, const RelativeMotion& motion);
  void drawSample(std::size_t count, std::size_t size);

  OutlierRejectionOptions options_;
  std::mt19937_64 random_;
  // Kept from call to call, so that little is allocated for an image.
  std::vector<std::size_t> sample_;
  std::unique_ptr<EpipolarTable> table_;
  std::vector<float> squares_;
};

}  // namespace vins::feature_tracker
