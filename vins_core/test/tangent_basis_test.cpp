#include "vins_core/tangent_basis.h"

#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace vins {
namespace {

using Eigen::Vector3d;

/// Directions all over the sphere, and those where an axis or two have no component.
std::vector<Vector3d> directions() {
  std::vector<Vector3d> units;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    units.push_back(Vector3d(normal(random), normal(random), normal(random)).normalized());
  }
  for (int axis = 0; axis < 3; ++axis) {
    units.push_back(Vector3d::Unit(axis));
    units.push_back(-Vector3d::Unit(axis));
    units.push_back((Vector3d::Ones() - Vector3d::Unit(axis)).normalized());
    units.push_back((Vector3d::Unit(axis) + 1e-12 * Vector3d::Ones()).normalized());
  }
  return units;
}

TEST(TangentBasis, IsARotationWithTheVectorAsThirdColumn) {
  for (const Vector3d& unit : directions()) {
    Eigen::Matrix3d R;
    R << tangentBasis(unit), unit;
    // A few rounding errors of 1e-16 each.
    EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 2e-15) << unit.transpose();
    EXPECT_NEAR(R.determinant(), 1.0, 2e-15) << unit.transpose();
  }
}

TEST(TangentBasis, IsTheSameForTheSameVector) {
  for (const Vector3d& unit : directions()) EXPECT_EQ(tangentBasis(unit), tangentBasis(unit));
}

}  // namespace
}  // namespace vins
