#include "simulation/chessboard_images.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "vins_core/input_error.h"
#include "vins_core/so3.h"

namespace vins::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDark = 25.0, kBright = 225.0, kBackground = 110.0;
constexpr double kBorder = 4.0;  ///< free pixels between the board and the image's border
constexpr int kTries = 1000;

/// Gray level at a point of the board's plane, in squares from the first inner corner.
double grayAt(const camera_model::Chessboard& board, double x, double y) {
  const bool on_squares = x >= -1.0 && y >= -1.0 && x < board.columns && y < board.rows;
  if (on_squares) {
    const int parity = static_cast<int>(std::floor(x) + std::floor(y));
    return parity % 2 == 0 ? kDark : kBright;
  }
  const bool on_margin = x >= -2.0 && y >= -2.0 && x < board.columns + 1.0 && y < board.rows + 1.0;
  return on_margin ? kBright : kBackground;
}

/// Gray level that a ray of the camera meets; the background where it misses the board's plane.
double grayAlong(const Vector3d& bearing, const camera_model::Chessboard& board, const Pose& T_bc) {
  const Vector3d direction = T_bc.rotation * bearing;
  const double distance = -T_bc.position.z() / direction.z();
  if (!(distance > 0.0) || !std::isfinite(distance)) return kBackground;
  const Vector3d point = T_bc.position + distance * direction;
  return grayAt(board, point.x() / board.square, point.y() / board.square);
}

/// Grays of pixels before blur and noise.
class PixelShader {
 public:
  PixelShader(const camera_model::Camera& camera, const camera_model::Chessboard& board,
              const Pose& T_bc, int samples_per_side)
      : camera_(camera), board_(board), T_bc_(T_bc), samples_(samples_per_side) {}

  /// At the corners of all pixels, one row and one column more than there are pixels.
  cv::Mat1f cornerGrays() const {
    const camera_model::ImageSize size = camera_.imageSize();
    cv::Mat1f grays(size.height + 1, size.width + 1);
    for (int v = 0; v <= size.height; ++v) {
      for (int u = 0; u <= size.width; ++u) grays(v, u) = gray({u - 0.5, v - 0.5});
    }
    return grays;
  }

  /// Mean over the pixel. Where its four corners look alike no edge of a square crosses it.
  float pixelGray(const cv::Mat1f& corners, int u, int v) const {
    const float first = corners(v, u);
    if (corners(v, u + 1) == first && corners(v + 1, u) == first &&
        corners(v + 1, u + 1) == first) {
      return first;
    }
    float sum = 0.0F;
    for (int k = 0; k < samples_ * samples_; ++k) {
      const double x = (k % samples_ + 0.5) / samples_ - 0.5;
      const double y = (k / samples_ + 0.5) / samples_ - 0.5;
      sum += gray({u + x, v + y});
    }
    return sum / static_cast<float>(samples_ * samples_);
  }

 private:
  float gray(const Vector2d& pixel) const {
    const auto bearing = camera_.unproject(pixel);
    return bearing ? static_cast<float>(grayAlong(*bearing, board_, T_bc_)) : 0.0F;
  }

  const camera_model::Camera& camera_;
  const camera_model::Chessboard& board_;
  Pose T_bc_;
  int samples_;
};

bool seesWholeBoard(const camera_model::Camera& camera, const camera_model::Chessboard& board,
                    const Pose& T_cb) {
  const double s = board.square;
  for (const double x : {-s, board.columns * s}) {
    for (const double y : {-s, board.rows * s}) {
      const auto pixel = camera.project(T_cb * Vector3d(x, y, 0.0));
      if (!pixel || !camera.contains(*pixel, kBorder)) return false;
    }
  }
  for (const Vector3d& point : board.points()) {
    const auto pixel = camera.project(T_cb * point);
    if (!pixel || !camera.contains(*pixel, kBorder)) return false;
  }
  return true;
}

}  // namespace

Pose randomBoardPose(const camera_model::Camera& camera, const camera_model::Chessboard& board,
                     Random* random) {
  const camera_model::ImageSize size = camera.imageSize();
  const double width = (board.columns - 1) * board.square;
  const double height = (board.rows - 1) * board.square;
  for (int i = 0; i < kTries; ++i) {
    const auto ray =
        camera.unproject({random->uniform(0.0, size.width), random->uniform(0.0, size.height)});
    if (!ray) continue;
    const Vector3d turn(random->uniform(-0.8, 0.8), random->uniform(-0.8, 0.8),
                        random->uniform(-3.0, 3.0));
    const Eigen::Quaterniond R_cb =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), *ray) * so3::exp(turn);
    const Vector3d aimed(random->bits() % 2 * width, random->bits() % 2 * height, 0.0);
    const double range = random->uniform(0.6, 2.0) * width;
    const Pose T_cb(R_cb, range * *ray - R_cb * aimed);
    if (seesWholeBoard(camera, board, T_cb)) return T_cb;
  }
  throw InputError("camera '" + camera.name() + "': sees no chessboard whole, wherever it is held");
}

cv::Mat renderChessboard(const camera_model::Camera& camera, const camera_model::Chessboard& board,
                         const Pose& T_cb, const ChessboardImageOptions& options, Random* random) {
  const camera_model::ImageSize size = camera.imageSize();
  const PixelShader shader(camera, board, T_cb.inverse(), options.samples_per_side);
  const cv::Mat1f corners = shader.cornerGrays();
  cv::Mat1f image(size.height, size.width);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) image(v, u) = shader.pixelGray(corners, u, v);
  }
  cv::GaussianBlur(image, image, {0, 0}, options.blur);
  for (float& pixel : image) pixel += static_cast<float>(options.noise * random->normal());
  cv::Mat quantized;
  image.convertTo(quantized, CV_8UC1);
  return quantized;
}

}  // namespace vins::simulation
