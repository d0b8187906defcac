#include "pose_graph/graph/heading.h"

namespace vins::pose_graph {

Pose driftOf(const Pose& T_mb, const Pose& T_wb) {
  const Eigen::Quaterniond R_mw = yawRotation(yawOf(T_mb.rotation * T_wb.rotation.conjugate()));
  return {R_mw, T_mb.position - R_mw * T_wb.position};
}

}  // namespace vins::pose_graph
