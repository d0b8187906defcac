#include "feature_tracker/anchored_patch.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace vins::feature_tracker {
namespace {

constexpr int kIterations = 6;
constexpr float kDone = 0.02F;       // a step that moves less ends the search [px]
constexpr float kReach = 10.0F;      // of the memory around the image that is used [px]
constexpr float kStiffness = 0.02F;  // of the warp, as a share of its own equations
constexpr float kOffset = 64.0F;     // that makes coordinates around the image positive [px]
constexpr float kFlat = 1e-3F;       // deviation below which there is nothing to see [grey values]

/// Coordinate of a sample in the patch.
constexpr float coordinate(int index, int side) {
  return static_cast<float>(index) - 0.5F * static_cast<float>(side - 1);
}

}  // namespace

double AnchoredPatch::scale() const { return std::sqrt(std::abs(warp_.determinant())); }

bool AnchoredPatch::isInside(const cv::Mat& image, const cv::Point2f& pixel) const {
  constexpr float kHalf = 0.5F * kSide;
  const Eigen::Vector2f extent = kHalf * warp_.cwiseAbs().rowwise().sum();
  return pixel.x - extent.x() > -kReach && pixel.y - extent.y() > -kReach &&
         pixel.x + extent.x() < static_cast<float>(image.cols) + kReach - 2.0F &&
         pixel.y + extent.y() < static_cast<float>(image.rows) + kReach - 2.0F;
}

void AnchoredPatch::sample(const cv::Mat& image, const cv::Point2f& pixel, Samples* samples) const {
  constexpr int kPadded = 16;  // so that the compiler can do four at once, and no rest remains
  static_assert(kSide <= kPadded);
  const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(image.step);
  float* out = samples->data();
  std::array<float, kPadded> fx, fy, a{}, b{}, c{}, d{}, grey;
  std::array<int, kPadded> left, top;
  for (int row = 0; row < kSide; ++row, out += kSide) {
    const float dy = coordinate(row, kSide);
    const float x0 = pixel.x + warp_(0, 1) * dy, y0 = pixel.y + warp_(1, 1) * dy;
    for (int i = 0; i < kPadded; ++i) {
      // Truncation rounds down: the offset keeps both positive.
      const float x = x0 + warp_(0, 0) * coordinate(i, kSide) + kOffset;
      const float y = y0 + warp_(1, 0) * coordinate(i, kSide) + kOffset;
      left[i] = static_cast<int>(x), top[i] = static_cast<int>(y);
      fx[i] = x - static_cast<float>(left[i]), fy[i] = y - static_cast<float>(top[i]);
    }
    for (int i = 0; i < kSide; ++i) {
      const std::uint8_t* p = image.data + step * (top[i] - static_cast<int>(kOffset)) + left[i] -
                              static_cast<int>(kOffset);
      a[i] = p[0], b[i] = p[1], c[i] = p[step], d[i] = p[step + 1];
    }
    for (int i = 0; i < kPadded; ++i) {
      const float above = a[i] + fx[i] * (b[i] - a[i]);
      const float below = c[i] + fx[i] * (d[i] - c[i]);
      grey[i] = above + fy[i] * (below - above);
    }
    std::copy_n(grey.begin(), kSide, out);
  }
}

void AnchoredPatch::anchor(const cv::Mat& image, const cv::Point2f& pixel) {
  warp_.setIdentity();
  sample(image, pixel, &template_);
  Samples before, after;
  sample(image, {pixel.x - 1.0F, pixel.y}, &before);
  sample(image, {pixel.x + 1.0F, pixel.y}, &after);
  for (int i = 0; i < kSamples; ++i) gradient_x_[i] = 0.5F * (after[i] - before[i]);
  sample(image, {pixel.x, pixel.y - 1.0F}, &before);
  sample(image, {pixel.x, pixel.y + 1.0F}, &after);
  for (int i = 0; i < kSamples; ++i) gradient_y_[i] = 0.5F * (after[i] - before[i]);
  Eigen::Map<Eigen::Array<float, kSamples, 1>> grey(template_.data());
  grey -= grey.mean();
  deviation_ = grey.matrix().norm();

  Matrix6f hessian = Matrix6f::Zero();
  for (int i = 0; i < kSamples; ++i) {
    const float x = coordinate(i % kSide, kSide), y = coordinate(i / kSide, kSide);
    const float gx = gradient_x_[i], gy = gradient_y_[i];
    Vector6f J;
    J << gx, gy, x * gx, y * gx, x * gy, y * gy;
    hessian.noalias() += J * J.transpose();
  }
  hessian.diagonal().tail<4>() *= 1.0F + kStiffness;
  hessian.diagonal().array() += 1e-3F;
  inverse_hessian_ = hessian.inverse();
}

double AnchoredPatch::normalizedResiduals(const Samples& samples, Samples* residuals) const {
  Eigen::Map<const Eigen::Array<float, kSamples, 1>> grey(samples.data());
  Eigen::Map<const Eigen::Array<float, kSamples, 1>> reference(template_.data());
  Eigen::Map<Eigen::Array<float, kSamples, 1>> out(residuals->data());
  out = grey - grey.mean();
  const float deviation = out.matrix().norm();
  if (deviation < kFlat || deviation_ < kFlat) return 0.0;
  const float correlation = (out * reference).sum() / (deviation * deviation_);
  out = out * (deviation_ / deviation) - reference;
  return correlation;
}

AnchoredPatch::Vector6f AnchoredPatch::gradientOf(const Samples& residuals) const {
  Vector6f b = Vector6f::Zero();
  for (int row = 0; row < kSide; ++row) {
    float sum_x = 0.0F, sum_y = 0.0F, sum_x_x = 0.0F, sum_x_y = 0.0F;
    for (int i = 0; i < kSide; ++i) {
      const int k = row * kSide + i;
      const float by_x = gradient_x_[k] * residuals[k];
      const float by_y = gradient_y_[k] * residuals[k];
      const float x = coordinate(i, kSide);
      sum_x += by_x, sum_y += by_y, sum_x_x += x * by_x, sum_x_y += x * by_y;
    }
    const float y = coordinate(row, kSide);
    b[0] += sum_x, b[1] += sum_y;
    b[2] += sum_x_x, b[3] += y * sum_x, b[4] += sum_x_y, b[5] += y * sum_y;
  }
  return b;
}

PatchAlignment AnchoredPatch::align(const cv::Mat& image, const cv::Point2f& start) {
  PatchAlignment alignment;
  alignment.pixel = start;
  const Eigen::Matrix2f warp_before = warp_;
  Samples samples, residuals;
  for (int iteration = 0;; ++iteration) {
    if (!isInside(image, alignment.pixel) || !(scale() > 0.2 && scale() < 5.0)) {
      warp_ = warp_before;
      return {};
    }
    sample(image, alignment.pixel, &samples);
    alignment.correlation = normalizedResiduals(samples, &residuals);
    if (iteration == kIterations) break;
    const Vector6f step = inverse_hessian_ * gradientOf(residuals);
    Eigen::Matrix2f growth;
    growth << 1.0F + step[2], step[3], step[4], 1.0F + step[5];
    warp_ = warp_ * growth.inverse();
    const Eigen::Vector2f shift = warp_ * step.head<2>();
    alignment.pixel -= cv::Point2f(shift.x(), shift.y());
    if (shift.squaredNorm() < kDone * kDone && iteration > 0) break;
  }
  alignment.inside = true;
  return alignment;
}

}  // namespace vins::feature_tracker
