#pragma once

#include <map>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "vins_estimator/window/linearization.h"
#include "vins_estimator/window/sliding_window.h"

namespace vins::estimator {

/// The window's least-squares problem with all but the poses (and the rig's calibration) eliminated
/// by hand: landmarks by the Schur complement of their 3x3 blocks, velocities and biases by a
/// Cholesky factorization in which they stand first. What is left ("steps") are six numbers for
/// each view - the frames, then the old keyframe if there is one - and the rig's variables where it
/// is refined.
///
/// The window must outlive it and must not change meanwhile.
class WindowSystem {
 public:
  /// Values of all unknowns.
  struct Point {
    WindowValues values;
    std::vector<LandmarkParameters> landmarks;  ///< of those with depth, by rising id
  };

  /// `huber`: where bearings' loss turns from square to linear [deviations].
  WindowSystem(const SlidingWindow& window, double huber);

  /// The values that the window has now.
  Point present() const;
  void writeTo(const Point& point, SlidingWindow* window) const;

  std::size_t frameCount() const { return window_.frames.size(); }
  std::size_t viewCount() const { return frameCount() + (window_.loop ? 1 : 0); }
  bool refinesRig() const { return window_.refines_rig; }
  const RigVariables& rigVariables() const { return window_.rig_variables; }
  Eigen::Index stepCount() const;
  std::size_t landmarkCount() const { return landmarks_.size(); }
  std::size_t observationCount() const { return observations_.size(); }

  /// Half the sum of squares, bearings' by their robust loss.
  double cost(const Point& point) const;

  /// Linearizes at the point and eliminates; false where the information is not positive definite.
  bool linearize(const Point& point);

  // Of the last linearization:

  /// Upper triangular R with R^T R = information of the steps, all else eliminated.
  Eigen::MatrixXd sqrtInformation() const;
  /// y with R^T y = gradient by the steps, all else eliminated.
  Eigen::VectorXd sqrtGradient() const;
  /// The point moved by the steps, all else to the best of the linear model for that.
  Point moved(const Eigen::VectorXd& steps) const;
  /// Covariance of the newest state.
  Matrix15d newestCovariance() const;
  /// Covariance of the rig's errors; zero where they are no variables.
  RigMatrix rigCovariance() const;
  /// Covariance of the pose of view `b` in the body frame of view `a`: position, rotation (right).
  Eigen::Matrix<double, 6, 6> relativeCovariance(std::size_t a, std::size_t b) const;
  /// Information of all states, landmarks eliminated: 15 rows for each frame, by ErrorState.
  Eigen::MatrixXd information() const;

 private:
  using Matrix63d = Eigen::Matrix<double, 6, 3>;
  using MatrixRig3d = Eigen::Matrix<double, kCameraRigSize, 3>;
  struct FlatObservation {
    const BearingMeasurement* measured;
    std::size_t target;
  };
  struct FlatLandmark {
    const Landmark* landmark;
    std::size_t host;
    std::size_t begin;  ///< of its observations; the first is the host's own
    std::size_t end;
  };
  /// What brings a landmark along when the poses move.
  struct Elimination {
    Eigen::Matrix3d H_inverse;
    Eigen::Vector3d g;
    MatrixRig3d W_rig;  ///< of those that observations show; set where the rig is refined
  };

  void collectObservations(const std::map<FrameId, std::size_t>& index, const Landmark& landmark);
  Eigen::Index poseColumn(std::size_t view) const;
  Eigen::Index rigColumn() const { return poseColumn(viewCount()); }
  Eigen::Index rigSize() const { return refinesRig() ? rigVariables().size() : 0; }
  Eigen::Index size() const { return rigColumn() + rigSize(); }
  static Eigen::Index motionColumn(std::size_t frame);
  Eigen::Index column(const Prior::Part& part) const;
  void preparePrior();
  void addLandmark(std::size_t landmark);
  void addObservation(const LinearizedObservation& o, std::size_t host);
  template <int columns>
  void addRig(const LinearizedObservation& o, std::size_t host, Elimination* elimination);
  void eliminate(std::size_t landmark);
  template <int columns>
  void eliminateFromRig(const FlatLandmark& landmark, const Elimination& elimination);
  void addImu(std::size_t frame);
  void addImuIntrinsics(std::size_t frame, const Eigen::Matrix<double, 15, 30>& J_states,
                        const Matrix15d& J, const Vector15d& r);
  void addStillness(std::size_t frame);
  void addRest(std::size_t frame);
  void addOldTilt();
  void addPrior();
  Eigen::VectorXd priorResidual(const Point& point) const;
  double bearingCost(const Point& point) const;
  Eigen::VectorXd motionSteps(const Eigen::VectorXd& steps) const;
  void moveLandmarks(const Eigen::VectorXd& steps,
                     std::vector<LandmarkParameters>* landmarks) const;
  const Pose& poseOf(std::size_t view) const;

  const SlidingWindow& window_;
  double huber_;
  std::vector<FlatObservation> observations_;
  std::vector<FlatLandmark> landmarks_;
  Eigen::MatrixXd prior_information_;  ///< lower triangle, in the system's order

  Point at_;                 ///< of the last linearization
  WindowGeometry geometry_;  ///< there
  Eigen::MatrixXd H_;        ///< lower triangle: motions first, then poses
  Eigen::VectorXd g_;
  std::vector<Matrix63d, Eigen::aligned_allocator<Matrix63d>> W_;  ///< for each observation
  std::vector<Elimination, Eigen::aligned_allocator<Elimination>> eliminations_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  Eigen::VectorXd y_;  ///< L^-1 g
};

}  // namespace vins::estimator
