#pragma once

#include <Eigen/Core>

#include "pose_graph/graph/keyframe_graph.h"
#include "pose_graph/graph/minimizer.h"
#include "pose_graph/graph/robust_kernel.h"

namespace vins::pose_graph {

/// Error between two heading frames (T. Qin, P. Li, S. Shen, "VINS-Mono", T-RO 2018, equation 37):
///   r = ( (R_z(yaw_i)^T (p_j - p_i) - p_ij) / sigma_p,  wrap(yaw_j - yaw_i - yaw_ij) / sigma_yaw
///   ).
struct FourDofModel {
  static constexpr int kDim = 4;
  using Block = Eigen::Matrix<double, kDim, kDim>;
  using Segment = Eigen::Matrix<double, kDim, 1>;  ///< x, y, z [m], yaw [rad]

  /// A heading frame in the map.
  struct State {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
    double yaw = 0.0;                                    ///< from the odometry's axes [rad]
  };

  struct Edge {
    int from = 0, to = 0;                                ///< numbers of states
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< p_ij [m]
    double yaw = 0.0;                                    ///< yaw_ij [rad]
    double position_weight = 1.0;                        ///< 1 / sigma_p [1/m]
    double yaw_weight = 1.0;                             ///< 1 / sigma_yaw [1/rad]
    RobustKernel kernel;
  };

  static State plus(const State& state, const Segment& step);

  /// The whitened error and, unless null, its Jacobians by the two states.
  static void evaluate(const Edge& edge, const State& from, const State& to, Segment* r,
                       Block* J_r_from, Block* J_r_to);
};

/// What optimizeFourDof() goes by.
struct FourDofOptions {
  /// Of loop edges only: the odometry's have no outliers. 2 is the expected length of a whitened
  /// error of four numbers.
  RobustKernel loop_kernel{KernelType::kHuber, 2.0};
  /// Ends where a step promises less than 1e-5 of the cost: of 2,000 keyframes each then moves by
  /// less than a millimetre.
  MinimizerOptions minimizer{MinimizerMethod::kLevenbergMarquardt, 20, 1e-5, 1e-6, 1e-16, {}};

  /// Throws InputError naming the option that is out of range.
  void validate() const;
};

struct FourDofResult {
  GraphCorrection correction;  ///< of the free keyframes; empty where the minimization has failed
  MinimizerSummary summary;
};

/// Finds positions and yaws that fit odometry and loops best; roll and pitch, which gravity has
/// made observable, stay the odometry's. In each component the keyframes after the oldest end of a
/// loop are free; that end and all before it stay.
FourDofResult optimizeFourDof(const KeyframeGraph& graph, const FourDofOptions& options);

}  // namespace vins::pose_graph
