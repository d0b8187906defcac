#include "simulation/spline_fit.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Columns3 = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Where the knots lie in a recording.
struct KnotGrid {
  double begin;
  double interval;
  Eigen::Index controls;

  double timeOf(Eigen::Index control) const {
    return begin + static_cast<double>(control - 2) * interval;
  }
};

std::vector<double> timesOf(const Trajectory& trajectory) {
  std::vector<double> times;
  for (const StampedPose& pose : trajectory.poses()) {
    times.push_back(toSeconds(pose.stamp - trajectory.poses().front().stamp));
  }
  return times;
}

KnotGrid layKnots(double duration, const SplineFitOptions& options) {
  const double span = duration + 2.0 * options.margin;
  const auto segments = static_cast<Eigen::Index>(std::ceil(span / options.knot_interval));
  return {-options.margin, options.knot_interval, segments + kSplineOrder - 1};
}

/// Row i: weights of the control points at times[i].
SparseMatrix weightMatrix(const KnotGrid& grid, const std::vector<double>& times) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double place = (times[i] - grid.begin) / grid.interval;
    const double segment = std::floor(place);
    const QuinticWeights weights = quinticWeights(place - segment, grid.interval);
    for (int j = 0; j < kSplineOrder; ++j) {
      entries.emplace_back(static_cast<int>(i), static_cast<int>(segment) + j, weights.plain(j));
    }
  }
  SparseMatrix matrix(static_cast<Eigen::Index>(times.size()), grid.controls);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Rows: third differences of the control points, as jerk.
SparseMatrix jerkMatrix(const KnotGrid& grid) {
  const double scale = 1.0 / std::pow(grid.interval, 3);
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k + 3 < grid.controls; ++k) {
    entries.emplace_back(k, k, -scale);
    entries.emplace_back(k, k + 1, 3.0 * scale);
    entries.emplace_back(k, k + 2, -3.0 * scale);
    entries.emplace_back(k, k + 3, scale);
  }
  SparseMatrix matrix(grid.controls - 3, grid.controls);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// min over x of |W x - r|^2 / deviation^2 + |D x - e|^2 / jerk_deviation^2.
class SmoothingProblem {
 public:
  SmoothingProblem(const SparseMatrix& W, const SparseMatrix& D, double deviation,
                   double jerk_deviation)
      : Wt_(W.transpose() / (deviation * deviation)),
        Dt_(D.transpose() / (jerk_deviation * jerk_deviation)) {
    const SparseMatrix normal = SparseMatrix(Wt_ * W) + SparseMatrix(Dt_ * D);
    solver_.compute(normal);
    if (solver_.info() != Eigen::Success) {
      throw InputError("trajectory: too few poses to lay a smooth curve through them");
    }
  }

  Columns3 solve(const Columns3& r, const Columns3& e) const {
    const Columns3 right = Wt_ * r + Dt_ * e;
    return solver_.solve(right);
  }

 private:
  SparseMatrix Wt_;
  SparseMatrix Dt_;
  Eigen::SimplicialLDLT<SparseMatrix> solver_;
};

Columns3 fitPositions(const Trajectory& trajectory, const SmoothingProblem& problem,
                      Eigen::Index jerk_count) {
  Columns3 recorded(static_cast<Eigen::Index>(trajectory.poses().size()), 3);
  // About the first position, so that far-off coordinates cost no digits.
  const Eigen::Vector3d origin = trajectory.poses().front().T_wb.position;
  for (Eigen::Index i = 0; i < recorded.rows(); ++i) {
    recorded.row(i) = trajectory.poses()[static_cast<std::size_t>(i)].T_wb.position.transpose() -
                      origin.transpose();
  }
  Columns3 controls = problem.solve(recorded, Columns3::Zero(jerk_count, 3));
  controls.rowwise() += origin.transpose();
  return controls;
}

/// The recorded rotations at the control points' times, the nearest known one outside.
std::vector<Pose> startPoses(const Trajectory& trajectory, const KnotGrid& grid,
                             const Columns3& positions) {
  const auto& poses = trajectory.poses();
  std::vector<Pose> controls;
  for (Eigen::Index j = 0; j < grid.controls; ++j) {
    const double t = std::clamp(grid.timeOf(j), 0.0, trajectory.duration());
    const Stamp stamp = std::min(poses.front().stamp + toNanoseconds(t), poses.back().stamp);
    const auto pose = trajectory.interpolate(stamp, trajectory.duration());
    controls.emplace_back(pose->rotation, positions.row(j).transpose());
  }
  return controls;
}

/// Rotation vectors from the spline to the recorded poses, in the body frame.
Columns3 rotationResiduals(const Trajectory& trajectory, const TrajectorySpline& spline) {
  Columns3 residuals(static_cast<Eigen::Index>(trajectory.poses().size()), 3);
  for (Eigen::Index i = 0; i < residuals.rows(); ++i) {
    const StampedPose& recorded = trajectory.poses()[static_cast<std::size_t>(i)];
    const Pose pose = spline.poseAt(spline.secondsAt(recorded.stamp));
    residuals.row(i) = so3::log(pose.rotation.conjugate() * recorded.T_wb.rotation).transpose();
  }
  return residuals;
}

/// Minus the angular jerk of the control rotations: second differences of their steps.
Columns3 angularJerkResiduals(const std::vector<Pose>& controls, double interval) {
  const double scale = 1.0 / std::pow(interval, 3);
  std::vector<Eigen::Vector3d> steps;
  for (std::size_t j = 1; j < controls.size(); ++j) {
    steps.push_back(so3::log(controls[j - 1].rotation.conjugate() * controls[j].rotation));
  }
  Columns3 residuals(static_cast<Eigen::Index>(steps.size()) - 2, 3);
  for (Eigen::Index k = 0; k < residuals.rows(); ++k) {
    const auto i = static_cast<std::size_t>(k);
    residuals.row(k) = -scale * (steps[i + 2] - 2.0 * steps[i + 1] + steps[i]).transpose();
  }
  return residuals;
}

/// Gauss-Newton with the weights of a flat space as Jacobian, which they are up to the turn
/// between neighbouring control points.
void fitRotations(const Trajectory& trajectory, const KnotGrid& grid,
                  const SmoothingProblem& problem, int iterations, std::vector<Pose>* controls) {
  const Stamp epoch = trajectory.poses().front().stamp;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const TrajectorySpline spline(epoch, grid.begin, grid.interval, *controls);
    const Columns3 update = problem.solve(rotationResiduals(trajectory, spline),
                                          angularJerkResiduals(*controls, grid.interval));
    for (std::size_t j = 0; j < controls->size(); ++j) {
      const Eigen::Vector3d turn = update.row(static_cast<Eigen::Index>(j)).transpose();
      Eigen::Quaterniond& rotation = (*controls)[j].rotation;
      rotation = (rotation * so3::exp(turn)).normalized();
    }
  }
}

SplineFit withResiduals(const TrajectorySpline& spline, const Trajectory& trajectory) {
  SplineFit fit{spline};
  double position_squares = 0.0;
  for (const StampedPose& recorded : trajectory.poses()) {
    const Pose pose = spline.poseAt(spline.secondsAt(recorded.stamp));
    const double distance = (recorded.T_wb.position - pose.position).norm();
    position_squares += distance * distance;
    fit.position_max = std::max(fit.position_max, distance);
  }
  const Columns3 rotations = rotationResiduals(trajectory, spline);
  const auto count = static_cast<double>(trajectory.poses().size());
  fit.position_rms = std::sqrt(position_squares / count);
  fit.rotation_rms = std::sqrt(rotations.squaredNorm() / count);
  fit.rotation_max = rotations.rowwise().norm().maxCoeff();
  return fit;
}

void requirePositive(const char* name, double value) {
  if (std::isfinite(value) && value > 0.0) return;
  std::ostringstream message;
  message << "spline fit: " << name << " is " << value << "; allowed: a number above 0";
  throw InputError(message.str());
}

}  // namespace

void SplineFitOptions::validate() const {
  requirePositive("knot_interval", knot_interval);
  requirePositive("margin", margin);
  requirePositive("position_deviation", position_deviation);
  requirePositive("rotation_deviation", rotation_deviation);
  requirePositive("jerk_deviation", jerk_deviation);
  requirePositive("angular_jerk_deviation", angular_jerk_deviation);
  requirePositive("iterations", iterations);
}

std::ostream& operator<<(std::ostream& out, const SplineFit& fit) {
  constexpr double kDegrees = 180.0 / M_PI;
  return out << "position residuals: rms " << 1e3 * fit.position_rms << " mm, max "
             << 1e3 * fit.position_max << " mm; rotation residuals: rms "
             << kDegrees * fit.rotation_rms << " deg, max " << kDegrees * fit.rotation_max
             << " deg";
}

SplineFit fitSpline(const Trajectory& trajectory, const SplineFitOptions& options) {
  options.validate();
  if (trajectory.poses().size() < 2) {
    throw InputError("trajectory: found " + std::to_string(trajectory.poses().size()) +
                     " poses; allowed: at least 2");
  }
  const KnotGrid grid = layKnots(trajectory.duration(), options);
  const SparseMatrix W = weightMatrix(grid, timesOf(trajectory));
  const SparseMatrix D = jerkMatrix(grid);
  const SmoothingProblem position_problem(W, D, options.position_deviation, options.jerk_deviation);
  const SmoothingProblem rotation_problem(W, D, options.rotation_deviation,
                                          options.angular_jerk_deviation);
  const Columns3 positions = fitPositions(trajectory, position_problem, D.rows());
  std::vector<Pose> controls = startPoses(trajectory, grid, positions);
  fitRotations(trajectory, grid, rotation_problem, options.iterations, &controls);
  const Stamp epoch = trajectory.poses().front().stamp;
  return withResiduals({epoch, grid.begin, grid.interval, std::move(controls)}, trajectory);
}

}  // namespace vins::simulation
