#include "vins_estimator/inertial/imu_intrinsics.h"

namespace vins::estimator {

Eigen::Matrix3d accelerometerGain(const ImuIntrinsics& errors) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G(0, 0) += errors(0);
  G(1, 0) = errors(1);
  G(1, 1) += errors(2);
  G(2, 0) = errors(3);
  G(2, 1) = errors(4);
  G(2, 2) += errors(5);
  return G;
}

Eigen::Matrix3d gyroscopeGain(const ImuIntrinsics& errors) {
  using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return Eigen::Matrix3d::Identity() +
         Eigen::Map<const RowMajor3d>(errors.data() + kAccelerometerIntrinsics);
}

Eigen::Matrix<double, 3, 6> accelerometerGainJacobian(const Eigen::Vector3d& a) {
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J(0, 0) = a.x();
  J.block<1, 2>(1, 1) = a.head<2>().transpose();
  J.block<1, 3>(2, 3) = a.transpose();
  return J;
}

Eigen::Matrix<double, 3, 9> gyroscopeGainJacobian(const Eigen::Vector3d& w) {
  Eigen::Matrix<double, 3, 9> J = Eigen::Matrix<double, 3, 9>::Zero();
  for (int row = 0; row < 3; ++row) J.block<1, 3>(row, 3 * row) = w.transpose();
  return J;
}

}  // namespace vins::estimator
