#include "calibration_quality.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "vins_core/input_error.h"

namespace vins::camera_model {
namespace {

constexpr int kMinViews = 8;
constexpr double kMinCoverage = 0.6;          ///< share of cells with a corner
constexpr double kMinReach = 0.8;             ///< of the half-diagonal, by the outermost corners
constexpr double kMinTiltSpread = 20.0;       ///< [deg] between the board's normals
constexpr double kMaxFocalDeviation = 0.002;  ///< of the focal length
constexpr double kMinSeenShare = 0.999;       ///< of the pixels that the model gives a bearing
constexpr double kMaxCenterDeviation = 2.0;   ///< of the principal point [px]

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

double coverage(const std::vector<int>& cells) {
  const auto covered = std::count_if(cells.begin(), cells.end(), [](int n) { return n > 0; });
  return static_cast<double>(covered) / static_cast<double>(cells.size());
}

/// Distance of the outermost corner in use from the image's centre, as a share of its
/// half-diagonal.
double reach(ImageSize size, const std::vector<CalibrationView>& views,
             const Calibration& calibration) {
  const Eigen::Vector2d center(0.5 * size.width, 0.5 * size.height);
  double outermost = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewFit& fit = calibration.views[i];
    for (std::size_t j = 0; j < fit.inliers.size(); ++j) {
      if (fit.inliers[j]) outermost = std::max(outermost, (views[i].corners[j] - center).norm());
    }
  }
  return outermost / center.norm();
}

/// Largest angle between two boards' normals [deg].
double tiltSpread(const Calibration& calibration) {
  std::vector<Eigen::Vector3d> normals;
  for (const ViewFit& view : calibration.views) {
    if (view.used) normals.push_back(view.T_cb.rotation * Eigen::Vector3d::UnitZ());
  }
  double smallest_cosine = 1.0;
  for (const auto& a : normals) {
    for (const auto& b : normals) smallest_cosine = std::min(smallest_cosine, a.dot(b));
  }
  return std::acos(std::max(-1.0, smallest_cosine)) * 180.0 / M_PI;
}

/// Where the optical axis falls, and the focal lengths there: what every model has, whatever its
/// parameters are called. Rows: cx, cy, fx, fy [px].
Eigen::Vector4d centerAndFocalLengths(const Camera& camera) {
  ProjectionJacobians jacobians;
  const Eigen::Vector2d center = *camera.project(Eigen::Vector3d::UnitZ(), &jacobians);
  return {center.x(), center.y(), jacobians.J_pixel_point(0, 0), jacobians.J_pixel_point(1, 1)};
}

/// The camera with parameter `index` moved by `*step`; by the negative of it, which `*step` then
/// is, where the parameter is at a bound of its model.
std::unique_ptr<Camera> withMovedParameter(const Camera& camera, int index, double* step) {
  CameraParameters p = camera.parameters();
  p[index] += *step;
  try {
    return camera.withParameters(p);
  } catch (const InputError&) {
    p[index] -= 2.0 * *step;
    *step = -*step;
    return camera.withParameters(p);
  }
}

/// Standard deviations of centerAndFocalLengths(), by differences. The step is small against a
/// deviation, because strongly correlated parameters (xi and gamma) must cancel in first order.
Eigen::Vector4d centerAndFocalDeviations(const Calibration& calibration) {
  const CameraParameters p = calibration.camera->parameters();
  Eigen::Matrix<double, 4, Eigen::Dynamic> J(4, p.size());
  for (int i = 0; i < p.size(); ++i) {
    double step = 1e-4 * std::sqrt(calibration.covariance(i, i));
    J.col(i).setZero();
    if (step == 0.0) continue;
    const auto moved = withMovedParameter(*calibration.camera, i, &step);
    J.col(i) = (centerAndFocalLengths(*moved) - centerAndFocalLengths(*calibration.camera)) / step;
  }
  return (J * calibration.covariance * J.transpose()).diagonal().cwiseSqrt();
}

void judgeDeviations(const Calibration& calibration, std::vector<std::string>* texts) {
  const Eigen::Vector4d values = centerAndFocalLengths(*calibration.camera);
  const Eigen::Vector4d deviations = centerAndFocalDeviations(calibration);
  const double focal = (deviations.tail<2>().cwiseQuotient(values.tail<2>())).maxCoeff();
  const double center = deviations.head<2>().maxCoeff();
  if (focal > kMaxFocalDeviation) {
    texts->push_back(
        format("the focal length is known to %.2f %% only: add views with the board "
               "tilted by 30 to 45 degrees",
               100.0 * focal));
  }
  if (center > kMaxCenterDeviation) {
    texts->push_back(
        format("the principal point is known to %.1f px only: add views with the board "
               "tilted and turned, near the borders of the image",
               center));
  }
}

/// Share of the image's pixels that have a bearing.
double seenShare(const Camera& camera) {
  int seen = 0, all = 0;
  for (int v = 0; v < camera.imageSize().height; v += 8) {
    for (int u = 0; u < camera.imageSize().width; u += 8) {
      ++all;
      seen += camera.unproject(Eigen::Vector2d(u, v)) ? 1 : 0;
    }
  }
  return static_cast<double>(seen) / all;
}

}  // namespace

std::vector<int> cornersPerCell(ImageSize size, const std::vector<CalibrationView>& views,
                                const Calibration& calibration) {
  std::vector<int> cells(kCoverageColumns * kCoverageRows, 0);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewFit& fit = calibration.views[i];
    for (std::size_t j = 0; fit.used && j < fit.inliers.size(); ++j) {
      if (!fit.inliers[j]) continue;
      const Eigen::Vector2d& corner = views[i].corners[j];
      const int column = static_cast<int>(corner.x() / size.width * kCoverageColumns);
      const int row = static_cast<int>(corner.y() / size.height * kCoverageRows);
      ++cells[std::clamp(row, 0, kCoverageRows - 1) * kCoverageColumns +
              std::clamp(column, 0, kCoverageColumns - 1)];
    }
  }
  return cells;
}

std::vector<std::string> weaknesses(const CalibrationOptions& options,
                                    const std::vector<CalibrationView>& views,
                                    const Calibration& calibration) {
  std::vector<std::string> texts;
  const auto used = std::count_if(calibration.views.begin(), calibration.views.end(),
                                  [](const ViewFit& view) { return view.used; });
  if (used < kMinViews) {
    texts.push_back(
        format("only %d views in use: take %d or more", static_cast<int>(used), 2 * kMinViews));
  }
  const double covered = coverage(cornersPerCell(options.image_size, views, calibration));
  if (covered < kMinCoverage) {
    texts.push_back(
        format("the corners cover %.0f %% of the image: move the board through all of it",
               100.0 * covered));
  }
  const double reached = reach(options.image_size, views, calibration);
  if (reached < kMinReach) {
    texts.push_back(
        format("no corner is further out than %.0f %% of the half-diagonal: distortion "
               "beyond it is a guess; hold the board into the image's corners",
               100.0 * reached));
  }
  const double spread = tiltSpread(calibration);
  if (spread < kMinTiltSpread) {
    texts.push_back(
        format("all boards face the same way to %.0f degrees: focal length and distance "
               "cannot be told apart; tilt the board",
               spread));
  }
  const double seen = seenShare(*calibration.camera);
  if (seen < kMinSeenShare) {
    texts.push_back(
        format("%.1f %% of the pixels have no bearing in the fitted model: fine where the "
               "lens leaves them black, else a sign of too few corners there",
               100.0 * (1.0 - seen)));
  }
  if (calibration.covariance.size() == 0) {
    texts.push_back(
        "the views do not determine all parameters: take more and more varied ones, or "
        "choose a model with fewer parameters");
  } else {
    judgeDeviations(calibration, &texts);
  }
  return texts;
}

}  // namespace vins::camera_model
