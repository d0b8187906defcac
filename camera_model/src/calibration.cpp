#include "camera_model/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "calibration_problem.h"
#include "calibration_quality.h"
#include "calibration_start.h"
#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

constexpr std::size_t kMinViews = 3;
constexpr double kStartScale = 2.0;  ///< of the robust loss while the camera is still a guess [px]
constexpr double kMissingError = 20.0;  ///< what a corner without a projection counts, at most [px]
constexpr double kMaxStartError = 15.0;  ///< root mean square beyond which no camera was found [px]
/// Median length of a two-dimensional normal vector of unit deviation.
constexpr double kRayleighMedian = 1.17741002;
/// A view of which less than this share of corners agrees is left out.
constexpr double kMinInlierShare = 0.5;

using Points = std::vector<Eigen::Vector3d>;
using Views = std::vector<CalibrationView>;

void checkViews(const CalibrationOptions& options, const Views& views) {
  if (views.size() < kMinViews) {
    throw InputError("calibration: found " + std::to_string(views.size()) +
                     " views of the board; allowed: at least " + std::to_string(kMinViews));
  }
  const auto count = static_cast<std::size_t>(options.board.columns * options.board.rows);
  for (const CalibrationView& view : views) {
    if (view.corners.size() != count) {
      throw InputError("calibration: " + view.name + ": found " +
                       std::to_string(view.corners.size()) +
                       " corners; allowed: " + std::to_string(count));
    }
    for (const Eigen::Vector2d& corner : view.corners) {
      const bool inside = corner.x() >= -1.0 && corner.x() <= options.image_size.width &&
                          corner.y() >= -1.0 && corner.y() <= options.image_size.height;
      if (!inside) {
        throw InputError("calibration: " + view.name + ": a corner lies outside of the image of " +
                         std::to_string(options.image_size.width) + " x " +
                         std::to_string(options.image_size.height));
      }
    }
  }
}

/// Mean square of the residuals' lengths, each counted as kMissingError at most.
double boundedError(const Points& points, const Views& views, const CalibrationState& state) {
  double sum = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!state.poses[i]) {
      sum += kMissingError * kMissingError * static_cast<double>(points.size());
      continue;
    }
    for (const auto& r : cornerResiduals(*state.camera, *state.poses[i], points, views[i])) {
      sum += std::min(r.squaredNorm(), kMissingError * kMissingError);
    }
  }
  return sum / static_cast<double>(views.size() * points.size());
}

/// Poses of the views for a camera; a view whose pose does not put every point into the camera's
/// sight has none.
void findPoses(const Points& points, const Views& views, bool only_missing,
               CalibrationState* state) {
  state->poses.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (only_missing && state->poses[i]) continue;
    state->poses[i] = poseOfView(*state->camera, points, views[i].corners);
    if (!state->poses[i]) continue;
    for (const auto& r : cornerResiduals(*state->camera, *state->poses[i], points, views[i])) {
      if (!r.allFinite()) {
        state->poses[i].reset();
        break;
      }
    }
  }
}

CalibrationState bestStart(const CalibrationOptions& options, const Points& points,
                           const Views& views) {
  const CornerMask all(views.size(), std::vector<bool>(points.size(), true));
  CalibrationState best;
  double best_error = std::numeric_limits<double>::infinity();
  for (std::unique_ptr<Camera>& camera : startingCameras(options)) {
    CalibrationState state;
    state.camera = std::move(camera);
    findPoses(points, views, false, &state);
    adjust(points, views, all, {30, kStartScale, false}, &state);
    findPoses(points, views, true, &state);
    adjust(points, views, all, {30, kStartScale, false}, &state);
    const double error = boundedError(points, views, state);
    if (error >= best_error) continue;
    best_error = error;
    best = std::move(state);
  }
  if (!(best_error < kMaxStartError * kMaxStartError)) {
    throw InputError(std::string("calibration: no camera of the model ") + toString(options.model) +
                     " explains the views (best root mean square " +
                     std::to_string(std::sqrt(best_error)) +
                     " px); check the board's size and the order of its corners");
  }
  return best;
}

/// Deviation of one coordinate of the residuals, by the median of their lengths [px].
double robustDeviation(const Points& points, const Views& views, const CalibrationState& state) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!state.poses[i]) continue;
    for (const auto& r : cornerResiduals(*state.camera, *state.poses[i], points, views[i])) {
      lengths.push_back(r.norm());
    }
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle / kRayleighMedian;
}

/// Corners within the bound; views with too few of them lose their pose.
CornerMask findInliers(const CalibrationOptions& options, const Points& points, const Views& views,
                       CalibrationState* state) {
  const double bound =
      options.outlier_deviations * std::max(robustDeviation(points, views, *state), 1e-3);
  CornerMask mask(views.size(), std::vector<bool>(points.size(), false));
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!state->poses[i]) continue;
    const auto residuals = cornerResiduals(*state->camera, *state->poses[i], points, views[i]);
    std::size_t inliers = 0;
    for (std::size_t j = 0; j < points.size(); ++j) {
      mask[i][j] = !options.reject_outliers || residuals[j].norm() <= bound;
      inliers += mask[i][j] ? 1 : 0;
    }
    if (static_cast<double>(inliers) < kMinInlierShare * static_cast<double>(points.size())) {
      state->poses[i].reset();
      mask[i].assign(points.size(), false);
    }
  }
  return mask;
}

/// Robust adjustment, then plain least squares over the corners that agree, twice: the first choice
/// of corners was made with a camera that the outliers still pulled at.
CornerMask refine(const CalibrationOptions& options, const Points& points, const Views& views,
                  CalibrationState* state) {
  CornerMask mask(views.size(), std::vector<bool>(points.size(), true));
  const double scale = 2.0 * std::max(robustDeviation(points, views, *state), 0.05);
  adjust(points, views, mask, {100, scale, options.estimate_k3}, state);
  for (int round = 0; round < 2; ++round) {
    mask = findInliers(options, points, views, state);
    if (!adjust(points, views, mask, {300, 0.0, options.estimate_k3}, state)) {
      throw InputError("calibration: the adjustment did not converge; take more varied views");
    }
  }
  return mask;
}

ViewFit fitOfView(const CalibrationState& state, const Points& points, const CalibrationView& view,
                  const std::vector<bool>& mask, std::size_t index) {
  ViewFit fit;
  if (!state.poses[index]) return fit;
  fit.used = true;
  fit.T_cb = *state.poses[index];
  fit.residuals = cornerResiduals(*state.camera, fit.T_cb, points, view);
  fit.inliers = mask;
  double sum = 0.0;
  for (std::size_t j = 0; j < points.size(); ++j)
    sum += mask[j] ? fit.residuals[j].squaredNorm() : 0.0;
  fit.rms = std::sqrt(sum / static_cast<double>(std::count(mask.begin(), mask.end(), true)));
  return fit;
}

void sumUp(Calibration* calibration) {
  double used = 0.0, all = 0.0;
  for (const ViewFit& view : calibration->views) {
    for (std::size_t j = 0; j < view.residuals.size(); ++j) {
      const double squared = view.residuals[j].squaredNorm();
      all += squared;
      if (view.inliers[j]) used += squared;
      ++(view.inliers[j] ? calibration->corners_used : calibration->corners_left_out);
    }
  }
  const double count = calibration->corners_used;
  calibration->rms = std::sqrt(used / count);
  calibration->rms_with_outliers = std::sqrt(all / (count + calibration->corners_left_out));
}

/// Covariance of the parameters for corners as noisy as the residuals are.
Eigen::MatrixXd covarianceOf(const CalibrationOptions& options, const Points& points,
                             const Views& views, const CornerMask& mask,
                             const CalibrationState& state, double rms) {
  const auto unit = parameterCovariance(points, views, mask, options.estimate_k3, state);
  if (!unit) return {};
  return 0.5 * rms * rms * *unit;  // rms is that of two coordinates
}

}  // namespace

void CalibrationOptions::validate() const {
  board.validate();
  if (image_size.width <= 0 || image_size.height <= 0) {
    throw InputError("calibration: the image size is not set");
  }
  if (!(outlier_deviations >= 2.0)) {
    throw InputError("calibration: outlier_deviations: found " +
                     std::to_string(outlier_deviations) + "; allowed: a number, at least 2");
  }
}

std::ostream& operator<<(std::ostream& out, const CalibrationOptions& options) {
  return out << "model: " << toString(options.model) << (options.estimate_k3 ? "" : " without k3")
             << "\ncamera: " << options.camera_name << "\nimages: " << options.image_size.width
             << " x " << options.image_size.height << "\nboard: " << options.board.columns << " x "
             << options.board.rows << " inner corners, squares of " << options.board.square << "\n";
}

Calibration calibrate(const CalibrationOptions& options,
                      const std::vector<CalibrationView>& views) {
  options.validate();
  checkViews(options, views);
  const Points points = options.board.points();
  CalibrationState state = bestStart(options, points, views);
  const CornerMask mask = refine(options, points, views, &state);
  Calibration calibration;
  for (std::size_t i = 0; i < views.size(); ++i) {
    calibration.views.push_back(fitOfView(state, points, views[i], mask[i], i));
  }
  sumUp(&calibration);
  calibration.covariance = covarianceOf(options, points, views, mask, state, calibration.rms);
  calibration.camera = std::move(state.camera);
  calibration.warnings = weaknesses(options, views, calibration);
  return calibration;
}

}  // namespace vins::camera_model
