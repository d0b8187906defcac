#include "calibration_start.h"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "camera_model/double_sphere.h"
#include "camera_model/eucm.h"
#include "camera_model/kannala_brandt.h"
#include "camera_model/mei.h"
#include "camera_model/pinhole_radtan.h"
#include "camera_model/scaramuzza.h"

namespace vins::camera_model {
namespace {

/// Focal lengths as shares of the image's width, from a half-sphere in 60 % of it to a telephoto
/// lens.
constexpr double kFocalShares[] = {0.2, 0.28, 0.4, 0.56, 0.8, 1.1, 1.6, 2.3};

std::unique_ptr<Camera> startingCamera(const CalibrationOptions& options, double f) {
  const ImageSize size = options.image_size;
  const double u = 0.5 * (size.width - 1);
  const double v = 0.5 * (size.height - 1);
  CameraParameters p;
  switch (options.model) {
    case CameraModel::kPinhole:
      p.setZero(9);
      p.head<4>() << f, f, u, v;
      return std::make_unique<PinholeRadtan>(options.camera_name, size, p);
    case CameraModel::kKannalaBrandt:
      p.setZero(8);
      p.tail<4>() << f, f, u, v;
      return std::make_unique<KannalaBrandt>(options.camera_name, size, p);
    case CameraModel::kMei:
      p.setZero(9);
      p[0] = 1.0;  // radius 2 f tan(angle / 2): halves the image of a pinhole, hence twice f
      p.tail<4>() << 2.0 * f, 2.0 * f, u, v;
      return std::make_unique<Mei>(options.camera_name, size, p);
    case CameraModel::kScaramuzza:
      // Equidistant: z = r / tan(r / f) to the fourth order in r.
      p.setZero(10);
      p << -f, 0.0, 1.0 / (3.0 * f), 0.0, 1.0 / (45.0 * f * f * f), 1.0, 0.0, 0.0, u, v;
      return std::make_unique<Scaramuzza>(options.camera_name, size, p);
    case CameraModel::kDoubleSphere:
      // Of wide lenses as they are: from xi = 0 some end at xi = 1, far from the best fit. On the
      // axis n is (1 + xi) z, hence the focal length.
      p.setZero(6);
      p << -0.2, 0.6, 0.8 * f, 0.8 * f, u, v;
      return std::make_unique<DoubleSphere>(options.camera_name, size, p);
    case CameraModel::kEucm:
      p.setZero(6);
      p << 0.5, 1.0, f, f, u, v;  // as Mei's with xi = 1
      return std::make_unique<Eucm>(options.camera_name, size, p);
  }
  return nullptr;
}

/// Plane coordinates moved and scaled so that their mean is zero and their mean square is one.
struct NormalizedPlane {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double scale = 0.0;

  explicit NormalizedPlane(const std::vector<Eigen::Vector3d>& points) {
    for (const Eigen::Vector3d& point : points) mean += point.head<2>() / points.size();
    for (const Eigen::Vector3d& point : points) {
      scale += (point.head<2>() - mean).squaredNorm() / points.size();
    }
    scale = std::sqrt(scale);
  }

  Eigen::Vector3d operator()(const Eigen::Vector3d& point) const {
    return ((point.head<2>() - mean) / scale).homogeneous();
  }
};

/// H of unit norm with bearing x (H point) = 0 in the least-squares sense.
Eigen::Matrix3d sphereHomography(const std::vector<Eigen::Vector3d>& plane_points,
                                 const std::vector<Eigen::Vector3d>& bearings) {
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < bearings.size(); ++i) {
    const Eigen::Vector3d& b = bearings[i];
    Eigen::Matrix3d cross;
    cross << 0.0, -b.z(), b.y(), b.z(), 0.0, -b.x(), -b.y(), b.x(), 0.0;
    Eigen::Matrix<double, 3, 9> A;
    for (int j = 0; j < 3; ++j) A.middleCols<3>(3 * j) = plane_points[i][j] * cross;
    normal += A.transpose() * A;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(normal);
  return Eigen::Map<const Eigen::Matrix3d>(solver.eigenvectors().col(0).data());
}

}  // namespace

std::vector<std::unique_ptr<Camera>> startingCameras(const CalibrationOptions& options) {
  std::vector<std::unique_ptr<Camera>> cameras;
  for (const double share : kFocalShares) {
    cameras.push_back(startingCamera(options, share * options.image_size.width));
  }
  return cameras;
}

std::optional<Pose> planarPose(const std::vector<Eigen::Vector3d>& points,
                               const std::vector<Eigen::Vector3d>& bearings) {
  const NormalizedPlane normalize(points);
  std::vector<Eigen::Vector3d> plane_points;
  for (const Eigen::Vector3d& point : points) plane_points.push_back(normalize(point));
  Eigen::Matrix3d H = sphereHomography(plane_points, bearings);
  double in_front = 0.0;
  for (std::size_t i = 0; i < bearings.size(); ++i)
    in_front += bearings[i].dot(H * plane_points[i]);
  if (in_front < 0.0) H = -H;
  const double stretch = 0.5 * (H.col(0).norm() + H.col(1).norm());
  if (!(stretch > 1e-9)) return std::nullopt;
  H *= normalize.scale / stretch;
  const Eigen::Vector3d r1 = H.col(0) / normalize.scale;
  const Eigen::Vector3d r2 = H.col(1) / normalize.scale;
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() << r1, r2, r1.cross(r2);
  Pose T_cb = poseFromMatrix(T);
  const Eigen::Vector3d mean(normalize.mean.x(), normalize.mean.y(), 0.0);
  T_cb.position = H.col(2) - T_cb.rotation * mean;
  if (!T_cb.position.allFinite()) return std::nullopt;
  return T_cb;
}

std::optional<Pose> poseOfView(const Camera& camera, const std::vector<Eigen::Vector3d>& points,
                               const std::vector<Eigen::Vector2d>& corners) {
  std::vector<Eigen::Vector3d> bearings;
  for (const Eigen::Vector2d& corner : corners) {
    const auto bearing = camera.unproject(corner);
    if (!bearing) return std::nullopt;
    bearings.push_back(*bearing);
  }
  return planarPose(points, bearings);
}

}  // namespace vins::camera_model
