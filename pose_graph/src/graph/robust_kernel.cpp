#include "pose_graph/graph/robust_kernel.h"

#include <cmath>

#include "vins_core/option_check.h"

namespace vins::pose_graph {

double RobustKernel::cost(double squared_error) const {
  const double squared_width = width * width;
  switch (type) {
    case KernelType::kHuber:
      if (squared_error <= squared_width) return squared_error;
      return 2.0 * width * std::sqrt(squared_error) - squared_width;
    case KernelType::kCauchy:
      return squared_width * std::log1p(squared_error / squared_width);
    case KernelType::kGemanMcClure:
      return squared_width * squared_error / (squared_width + squared_error);
    case KernelType::kNone:
      break;
  }
  return squared_error;
}

double RobustKernel::weight(double squared_error) const {
  const double squared_width = width * width;
  const double share = squared_width / (squared_width + squared_error);
  switch (type) {
    case KernelType::kHuber:
      return squared_error <= squared_width ? 1.0 : width / std::sqrt(squared_error);
    case KernelType::kCauchy:
      return share;
    case KernelType::kGemanMcClure:
      return share * share;
    case KernelType::kNone:
      break;
  }
  return 1.0;
}

void RobustKernel::validate() const { requireWithin("robust kernel", "width", width, {1e-9, 1e9}); }

}  // namespace vins::pose_graph
