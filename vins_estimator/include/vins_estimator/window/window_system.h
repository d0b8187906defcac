#pragma once

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "vins_estimator/window/linearization.h"
#include "vins_estimator/window/sliding_window.h"

namespace vins {

/// The window's least-squares problem with all but the poses eliminated by hand: landmarks by the
/// Schur complement of their 3x3 blocks, velocities and biases by a Cholesky factorization in which
/// they stand first. What is left are six numbers a frame.
///
/// The window must outlive it and must not change meanwhile.
class WindowSystem {
 public:
  /// Values of all unknowns.
  struct Point {
    std::vector<NavState> states;               ///< of the window's frames
    std::vector<LandmarkParameters> landmarks;  ///< of those with depth, by rising id
  };

  /// `huber`: where bearings' loss turns from square to linear [deviations].
  WindowSystem(const SlidingWindow& window, double huber);

  /// The values that the window has now.
  Point present() const;
  void writeTo(const Point& point, SlidingWindow* window) const;

  std::size_t frameCount() const { return window_.frames.size(); }
  std::size_t landmarkCount() const { return landmarks_.size(); }
  std::size_t observationCount() const { return observations_.size(); }

  /// Half the sum of squares, bearings' by their robust loss.
  double cost(const Point& point) const;

  /// Linearizes at the point and eliminates; false where the information is not positive definite.
  bool linearize(const Point& point);

  // Of the last linearization:

  /// Upper triangular R with R^T R = information of the poses, all else eliminated.
  Eigen::MatrixXd sqrtInformation() const;
  /// y with R^T y = gradient by the poses, all else eliminated.
  Eigen::VectorXd sqrtGradient() const;
  /// The point moved: poses by six numbers for each frame, all else to the best of the linear
  /// model for that.
  Point moved(const Eigen::VectorXd& pose_steps) const;
  /// Covariance of the newest state.
  Matrix15d newestCovariance() const;
  /// Information of all states, landmarks eliminated: 15 rows for each frame, by ErrorState.
  Eigen::MatrixXd information() const;

 private:
  using Matrix63d = Eigen::Matrix<double, 6, 3>;
  struct FlatObservation {
    const TrackObservation* observation;
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
  };

  Eigen::Index poseColumn(std::size_t frame) const;
  static Eigen::Index motionColumn(std::size_t frame);
  Eigen::Index column(const Prior::Part& part) const;
  void preparePrior();
  void addLandmark(std::size_t landmark);
  void eliminate(std::size_t landmark);
  void addImu(std::size_t frame);
  void addStillness(std::size_t frame);
  void addPrior();
  Eigen::VectorXd priorResidual(const Point& point) const;
  double bearingCost(const Point& point) const;

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
  std::vector<Elimination> eliminations_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  Eigen::VectorXd y_;  ///< L^-1 g
};

}  // namespace vins
