#include "vins_estimator/initialization/five_point.h"

#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace vins::estimator {
namespace {

/// Polynomials in x, y, z by their coefficients, in the orders
///   linear:    x y z 1
///   quadratic: xx xy xz yy yz zz x y z 1
///   cubic:     xxx xxy xxz xyy xyz xzz yyy yyz yzz zzz, then as the quadratic ones.
using Linear = Eigen::Vector4d;
using Quadratic = Eigen::Matrix<double, 10, 1>;
using Cubic = Eigen::Matrix<double, 20, 1>;
template <typename Polynomial>
using PolynomialMatrix = std::array<std::array<Polynomial, 3>, 3>;

/// Where the product of two monomials stands.
constexpr int kQuadraticIndex[4][4] = {{0, 1, 2, 6}, {1, 3, 4, 7}, {2, 4, 5, 8}, {6, 7, 8, 9}};
constexpr int kCubicIndex[10][4] = {
    {0, 1, 2, 10}, {1, 3, 4, 11},    {2, 4, 5, 12},    {3, 6, 7, 13},    {4, 7, 8, 14},
    {5, 8, 9, 15}, {10, 11, 12, 16}, {11, 13, 14, 17}, {12, 14, 15, 18}, {16, 17, 18, 19}};

Quadratic product(const Linear& a, const Linear& b) {
  Quadratic c = Quadratic::Zero();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) c(kQuadraticIndex[i][j]) += a(i) * b(j);
  }
  return c;
}

void addProduct(const Quadratic& a, const Linear& b, Cubic* c) {
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 4; ++j) (*c)(kCubicIndex[i][j]) += a(i) * b(j);
  }
}

/// Rows e1..e4 (E by rows) that span what satisfies the five equations.
Eigen::Matrix<double, 9, 4> nullSpace(const Eigen::Matrix<double, 3, 5>& bearings_1,
                                      const Eigen::Matrix<double, 3, 5>& bearings_2) {
  Eigen::Matrix<double, 9, 5> equations;
  for (int k = 0; k < 5; ++k) {
    for (int i = 0; i < 3; ++i) {
      equations.block<3, 1>(3 * i, k) = bearings_2(i, k) * bearings_1.col(k);
    }
  }
  const Eigen::HouseholderQR<Eigen::Matrix<double, 9, 5>> qr(equations);
  const Eigen::Matrix<double, 9, 9> Q = qr.householderQ();
  return Q.rightCols<4>();
}

PolynomialMatrix<Linear> essentialPolynomials(const Eigen::Matrix<double, 9, 4>& basis) {
  PolynomialMatrix<Linear> E;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) E[i][j] = basis.row(3 * i + j).transpose();
  }
  return E;
}

/// E E^T - tr(E E^T) / 2.
PolynomialMatrix<Quadratic> reducedSquare(const PolynomialMatrix<Linear>& E) {
  PolynomialMatrix<Quadratic> square;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      square[i][j] =
          product(E[i][0], E[j][0]) + product(E[i][1], E[j][1]) + product(E[i][2], E[j][2]);
      square[j][i] = square[i][j];
    }
  }
  const Quadratic half_trace = 0.5 * (square[0][0] + square[1][1] + square[2][2]);
  for (int i = 0; i < 3; ++i) square[i][i] -= half_trace;
  return square;
}

Cubic determinant(const PolynomialMatrix<Linear>& E) {
  Cubic det = Cubic::Zero();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    addProduct(product(E[1][j], E[2][k]) - product(E[1][k], E[2][j]), E[0][i], &det);
  }
  return det;
}

/// The ten equations, one a row.
Eigen::Matrix<double, 10, 20> cubicEquations(const PolynomialMatrix<Linear>& E) {
  const PolynomialMatrix<Quadratic> square = reducedSquare(E);
  Eigen::Matrix<double, 10, 20> equations;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Cubic sum = Cubic::Zero();
      for (int k = 0; k < 3; ++k) addProduct(square[i][k], E[k][j], &sum);
      equations.row(3 * i + j) = sum.transpose();
    }
  }
  equations.row(9) = determinant(E).transpose();
  return equations;
}

/// Multiplication by x of the quadratic monomials, where the cubic ones are replaced by what the
/// equations say of them.
Eigen::Matrix<double, 10, 10> actionMatrix(const Eigen::Matrix<double, 10, 20>& equations) {
  const Eigen::Matrix<double, 10, 10> reduced =
      equations.leftCols<10>().partialPivLu().solve(equations.rightCols<10>());
  Eigen::Matrix<double, 10, 10> action = Eigen::Matrix<double, 10, 10>::Zero();
  action.topRows<6>() = -reduced.topRows<6>();
  action(6, 0) = action(7, 1) = action(8, 2) = action(9, 6) = 1.0;
  return action;
}

}  // namespace

std::vector<Eigen::Matrix3d> essentialMatrices(const Eigen::Matrix<double, 3, 5>& bearings_1,
                                               const Eigen::Matrix<double, 3, 5>& bearings_2) {
  constexpr double kRealShare = 1e-9;  // imaginary part of an eigenvalue that counts as real
  std::vector<Eigen::Matrix3d> solutions;
  const Eigen::Matrix<double, 9, 4> basis = nullSpace(bearings_1, bearings_2);
  const auto action = actionMatrix(cubicEquations(essentialPolynomials(basis)));
  if (!action.allFinite()) return solutions;
  const Eigen::EigenSolver<Eigen::Matrix<double, 10, 10>> solver(action);
  if (solver.info() != Eigen::Success) return solutions;
  for (int k = 0; k < 10; ++k) {
    const std::complex<double> value = solver.eigenvalues()(k);
    if (std::abs(value.imag()) > kRealShare * (1.0 + std::abs(value.real()))) continue;
    // The eigenvector's last four are x, y, z, 1, times anything.
    const Eigen::Vector4d weights = solver.eigenvectors().col(k).tail<4>().real();
    const Eigen::Matrix<double, 9, 1> e = (basis * weights).normalized();
    if (!e.allFinite()) continue;
    solutions.emplace_back(
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(e.data()));
  }
  return solutions;
}

}  // namespace vins::estimator
