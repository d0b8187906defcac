#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace vins::camera_model {

/// The camera models, by the names that configuration files give them (model_type).
enum class CameraModel {
  kPinhole,        ///< PINHOLE: pinhole with radial and tangential distortion
  kKannalaBrandt,  ///< KANNALA_BRANDT: equidistant fisheye
  kMei,            ///< MEI: unified omnidirectional, with radial and tangential distortion
  kScaramuzza,     ///< SCARAMUZZA: OCam polynomial
  kDoubleSphere,   ///< DOUBLE_SPHERE: two unit spheres and a pinhole
  kEucm            ///< EUCM: extended unified model, an ellipsoid and a pinhole
};

/// All of them.
constexpr CameraModel kCameraModels[] = {CameraModel::kPinhole,      CameraModel::kKannalaBrandt,
                                         CameraModel::kMei,          CameraModel::kScaramuzza,
                                         CameraModel::kDoubleSphere, CameraModel::kEucm};

/// The model's name in a configuration file, as above: "PINHOLE" and so on.
const char* toString(CameraModel model);

/// Inverse of toString(); letter case and '-' for '_' aside. Throws InputError naming the choices.
CameraModel cameraModelFromString(const std::string& name);

/// Pixels in a row, and rows.
struct ImageSize {
  int width = 0;
  int height = 0;

  bool operator==(const ImageSize& other) const {
    return width == other.width && height == other.height;
  }
  bool operator!=(const ImageSize& other) const { return !(*this == other); }
};

/// No model has more intrinsic parameters than this.
constexpr int kMaxCameraParameters = 12;

using CameraParameters = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxCameraParameters, 1>;

/// Derivatives of a projected pixel.
struct ProjectionJacobians {
  Eigen::Matrix<double, 2, 3> J_pixel_point;  ///< by the point in the camera frame [px/m]
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxCameraParameters>
      J_pixel_parameters;  ///< by parameters(), a column each
};

/// A calibrated camera. The camera frame has x to the right, y down, z along the optical axis;
/// pixel (0, 0) is the centre of the upper left pixel. Cameras are immutable and may be shared
/// between threads.
class Camera {
 public:
  virtual ~Camera() = default;

  const std::string& name() const { return name_; }
  ImageSize imageSize() const { return size_; }
  virtual CameraModel model() const = 0;

  /// Pixel of a point p_c [m] in the camera frame, or nothing where the camera cannot see it
  /// sharply: behind a pinhole, outside of the cone in which the model's map can be inverted, or
  /// at the camera's centre. The pixel may lie outside of the image: see contains().
  /// With `jacobians`, which may be null, also the derivatives.
  virtual std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_c,
                                                 ProjectionJacobians* jacobians) const = 0;
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_c) const {
    return project(p_c, nullptr);
  }

  /// Unit bearing in the camera frame of a pixel, or nothing where no bearing projects there.
  /// project(*unproject(x)) is x and unproject(*project(p)) is p / |p| to rounding.
  virtual std::optional<Eigen::Vector3d> unproject(const Eigen::Vector2d& pixel) const = 0;

  /// The intrinsic parameters, in the order of parameterNames().
  virtual CameraParameters parameters() const = 0;
  virtual std::vector<std::string> parameterNames() const = 0;

  /// The same model with other parameters. Throws InputError where they are of wrong number or
  /// describe no camera (a focal length that is not positive, a number that is not finite).
  virtual std::unique_ptr<Camera> withParameters(const CameraParameters& parameters) const = 0;

  /// The same optics on an image of another size: the image is resized, not cropped.
  virtual std::unique_ptr<Camera> scaledTo(ImageSize size) const = 0;

  /// The pixel lies inside of the image, at least `border` pixels from its outermost pixel centres.
  bool contains(const Eigen::Vector2d& pixel, double border = 0.0) const {
    return pixel.x() >= border && pixel.y() >= border && pixel.x() <= size_.width - 1 - border &&
           pixel.y() <= size_.height - 1 - border;
  }

 protected:
  /// Throws InputError where the size is not positive.
  Camera(std::string name, ImageSize size);

  /// Throws InputError naming the parameter: for constructors of models.
  void requirePositive(const char* parameter, double value) const;
  void requireFinite(const CameraParameters& parameters) const;
  static void requireCount(CameraModel model, const CameraParameters& parameters, int count);

 private:
  std::string name_;
  ImageSize size_;
};

}  // namespace vins::camera_model
