#include "vins_estimator/initialization/structure_adjustment.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

namespace vins::estimator {
namespace {

constexpr double kRobust = 1.5;      ///< residuals beyond it pull with constant force [deviations]
constexpr double kTolerance = 1e-4;  ///< of the cost: a joint adjustment follows

bool solve(int max_iterations, InitialBlocks* blocks, std::vector<InitialLandmark>* landmarks) {
  ceres::HuberLoss loss(kRobust);
  PoseManifold manifold;
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  const auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (PoseBlock& pose : blocks->poses) {
    problem.AddParameterBlock(pose.data(), 7, &manifold);
    ordering->AddElementToGroup(pose.data(), 1);
  }
  problem.SetParameterBlockConstant(blocks->poses.front().data());
  const Pose T_cc;
  addLandmarkResiduals(T_cc, &loss, blocks, landmarks, &problem, ordering.get());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = ordering;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = kTolerance;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable();
}

void normalizeScale(std::vector<Pose>* T_sc, std::vector<InitialLandmark>* landmarks) {
  double farthest = 0.0;
  for (const Pose& pose : *T_sc) farthest = std::max(farthest, pose.position.norm());
  if (!(farthest > 0.0)) return;
  for (Pose& pose : *T_sc) pose.position /= farthest;
  for (InitialLandmark& landmark : *landmarks) landmark.parameters.z() *= farthest;
}

bool allFinite(const std::vector<Pose>& T_sc) {
  return std::all_of(T_sc.begin(), T_sc.end(), [](const Pose& pose) {
    return pose.position.allFinite() && pose.rotation.coeffs().allFinite();
  });
}

}  // namespace

StructureAdjustment adjustStructure(int max_iterations, double gate, std::vector<Pose>* T_sc,
                                    std::vector<InitialLandmark>* landmarks) {
  StructureAdjustment result;
  if (landmarks->empty() || T_sc->empty()) return result;
  std::vector<NavState> states;
  for (const Pose& pose : *T_sc) {
    states.emplace_back();
    states.back().T_wb = pose;
  }
  const Pose T_cc;
  InitialBlocks blocks(states);
  if (!solve(max_iterations, &blocks, landmarks)) return result;
  result.outliers = removeOutliers(gate, T_cc, blocks, landmarks);
  if (landmarks->empty()) return result;
  if (result.outliers > 0 && !solve(max_iterations, &blocks, landmarks)) return result;
  result.rms = landmarkRms(T_cc, blocks, *landmarks);
  for (std::size_t i = 0; i < T_sc->size(); ++i) (*T_sc)[i] = toPose(blocks.poses[i].data());
  result.usable = allFinite(*T_sc) && std::isfinite(result.rms);
  normalizeScale(T_sc, landmarks);
  return result;
}

}  // namespace vins::estimator
