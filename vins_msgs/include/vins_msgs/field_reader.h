#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <sstream>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>
#include <ros/message_traits.h>
#include <ros/time.h>

#include "vins_core/input_error.h"
#include "vins_core/pose.h"

namespace vins_msgs {

/// A quaternion may be off unit length by this much: three decimals, as people write them. More is
/// a sender's error. Then it is normalized.
constexpr double kQuaternionTolerance = 1e-3;

/// A quaternion whose squared length is off 1 by less than this is a double's own rounding, however
/// many products it has come through, and is kept bit for bit: a stage in another process then gets
/// what one in the same process gets. Single precision (1e-7) is normalized.
constexpr double kQuaternionRounding = 1e-12;

/// A bearing may be off unit length by this much, which lets single precision (1e-7) through and
/// changes a residual by a millionth, far below any pixel noise; a point (x, y, 1) of the image
/// plane, the usual mistake, is farther off than this once it is 1.5 mrad from the optical axis. It
/// is not normalized, so that it stays the same bits as in one process.
constexpr double kBearingTolerance = 1e-6;

/// Reads the fields of one received message and refuses those that make no sense: throws
/// vins::InputError "vins_msgs/Keyframe at 12.000000005: points[3].bearing has length 1.1; allowed:
/// 1 within 1e-06". Costs nothing but the checks while all is well.
class FieldReader {
 public:
  template <typename Message>
  explicit FieldReader(const Message& message)
      : type_(ros::message_traits::DataType<Message>::value()) {
    if constexpr (ros::message_traits::HasHeader<Message>::value) stamp_ = &message.header.stamp;
  }

  /// Reader of the message that is field `member`.
  FieldReader inside(const char* member) const { return {*this, member, -1}; }

  /// Reader of the message that is element `index` of the list `member`.
  FieldReader inside(const char* member, std::size_t index) const {
    return {*this, member, static_cast<std::ptrdiff_t>(index)};
  }

  /// A float64[n] or vector field as it is, all finite.
  template <int n, typename Array>
  Eigen::Matrix<double, n, 1> vector(const char* field, const Array& values) const;
  Eigen::Vector3d vector(const char* field, const geometry_msgs::Vector3& values) const;

  /// A float64[3] field of unit length within kBearingTolerance.
  template <typename Array>
  Eigen::Vector3d bearing(const char* field, const Array& values) const;

  /// A float64[n * n] field, row-major, all finite.
  template <int n, typename Array>
  Eigen::Matrix<double, n, n> covariance(const char* field, const Array& values) const;

  /// The pose that this reader reads: finite, its quaternion of unit length within
  /// kQuaternionTolerance and normalized unless it is already.
  vins::Pose pose(const geometry_msgs::Pose& message) const;

  /// An integer between `lowest` and `highest`.
  int integer(const char* field, int value, int lowest, int highest) const;

  /// A finite number above 0.
  double positive(const char* field, double value) const;

  /// Throws: `found` is what is wrong with the field, `allowed` what would be right.
  [[noreturn]] void refuse(const char* field, const std::string& found,
                           const std::string& allowed) const;

 private:
  FieldReader(const FieldReader& outer, const char* member, std::ptrdiff_t index)
      : type_(outer.type_), stamp_(outer.stamp_), member_(member), index_(index) {}

  template <typename Values>
  void requireFinite(const char* field, const Values& values) const;
  void requireUnit(const char* field, double length, double tolerance) const;
  Eigen::Quaterniond rotation(const geometry_msgs::Quaternion& message) const;
  std::string place() const;

  const char* type_;
  const ros::Time* stamp_ = nullptr;  ///< null: a message without header
  const char* member_ = nullptr;      ///< null: the message itself
  std::ptrdiff_t index_ = -1;         ///< -1: the member is no list
};

template <int n, typename Array>
Eigen::Matrix<double, n, 1> FieldReader::vector(const char* field, const Array& values) const {
  static_assert(sizeof(Array) == n * sizeof(double), "field of another length");
  Eigen::Matrix<double, n, 1> result(values.data());
  requireFinite(field, result);
  return result;
}

inline Eigen::Vector3d FieldReader::vector(const char* field,
                                           const geometry_msgs::Vector3& values) const {
  Eigen::Vector3d result(values.x, values.y, values.z);
  requireFinite(field, result);
  return result;
}

template <typename Array>
Eigen::Vector3d FieldReader::bearing(const char* field, const Array& values) const {
  Eigen::Vector3d result = vector<3>(field, values);
  requireUnit(field, result.norm(), kBearingTolerance);
  return result;
}

template <int n, typename Array>
Eigen::Matrix<double, n, n> FieldReader::covariance(const char* field, const Array& values) const {
  const auto elements = vector<n * n>(field, values);
  return Eigen::Map<const Eigen::Matrix<double, n, n, Eigen::RowMajor>>(elements.data());
}

inline vins::Pose FieldReader::pose(const geometry_msgs::Pose& message) const {
  const Eigen::Vector3d position(message.position.x, message.position.y, message.position.z);
  requireFinite("position", position);
  return {rotation(message.orientation), position};
}

inline Eigen::Quaterniond FieldReader::rotation(const geometry_msgs::Quaternion& message) const {
  Eigen::Quaterniond q(message.w, message.x, message.y, message.z);
  requireFinite("orientation", q.coeffs());
  if (std::abs(q.squaredNorm() - 1.0) < kQuaternionRounding) return q;
  requireUnit("orientation", q.norm(), kQuaternionTolerance);
  return q.normalized();
}

inline int FieldReader::integer(const char* field, int value, int lowest, int highest) const {
  if (value >= lowest && value <= highest) return value;
  refuse(field, "is " + std::to_string(value),
         std::to_string(lowest) + " to " + std::to_string(highest));
}

inline double FieldReader::positive(const char* field, double value) const {
  if (std::isfinite(value) && value > 0.0) return value;
  std::ostringstream found;
  found << "is " << value;
  refuse(field, found.str(), "a finite number above 0");
}

template <typename Values>
void FieldReader::requireFinite(const char* field, const Values& values) const {
  if (values.allFinite()) return;
  Eigen::Index index = 0;
  while (std::isfinite(values[index])) ++index;
  std::ostringstream found;
  found << "has " << values[index] << " at index " << index;
  refuse(field, found.str(), "finite numbers");
}

inline void FieldReader::requireUnit(const char* field, double length, double tolerance) const {
  if (std::abs(length - 1.0) <= tolerance) return;
  std::ostringstream found, allowed;
  found.precision(9);
  found << "has length " << length;
  allowed << "1 within " << tolerance;
  refuse(field, found.str(), allowed.str());
}

inline void FieldReader::refuse(const char* field, const std::string& found,
                                const std::string& allowed) const {
  throw vins::InputError(place() + field + " " + found + "; allowed: " + allowed);
}

/// "vins_msgs/Keyframe at 12.000000005: points[3]."
inline std::string FieldReader::place() const {
  std::ostringstream place;
  place << type_;
  if (stamp_ != nullptr) {
    char nanoseconds[16];
    std::snprintf(nanoseconds, sizeof(nanoseconds), "%09u", stamp_->nsec);
    place << " at " << stamp_->sec << "." << nanoseconds;
  }
  place << ": ";
  if (member_ != nullptr) place << member_;
  if (index_ >= 0) place << "[" << index_ << "]";
  if (member_ != nullptr) place << ".";
  return place.str();
}

}  // namespace vins_msgs
