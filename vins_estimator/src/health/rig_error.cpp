#include "vins_estimator/health/rig_error.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace vins::estimator {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The rows of a score that belong to some parts.
struct Score {
  MatrixXd information;
  VectorXd gradient;
};

std::vector<int> rowsOf(const std::vector<RigPart>& parts) {
  std::vector<int> rows;
  for (const RigPart part : parts) {
    const RigErrorRows own = estimator::rowsOf(part);
    for (int i = 0; i < own.count; ++i) rows.push_back(own.begin + i);
  }
  return rows;
}

/// A meter, radian, second or the whole focal length are known without any window: that keeps
/// windows in which nothing shows an error out of trouble.
Score choose(const RigScore& score, const std::vector<int>& rows) {
  Score chosen{score.information(rows, rows), score.gradient(rows)};
  chosen.information.diagonal().array() += 1.0;
  return chosen;
}

Score sumOf(const std::deque<RigScore>& scores, const std::vector<int>& rows) {
  RigScore sum;
  for (const RigScore& score : scores) {
    sum.information += score.information;
    sum.gradient += score.gradient;
  }
  return choose(sum, rows);
}

VectorXd bestError(const Score& score) { return -score.information.ldlt().solve(score.gradient); }

double gainOf(const Score& score) {
  return score.gradient.size() == 0 ? 0.0 : -score.gradient.dot(bestError(score));
}

/// Chi squared of the windows' own errors about the common one, over its degrees of freedom. It is
/// widened much as Student's distribution is against the normal one.
double scatterAbout(const VectorXd& error, const std::deque<RigScore>& scores,
                    const std::vector<int>& rows) {
  if (scores.size() < 2) return 1.0;
  double chi_squared = 0.0;
  for (const RigScore& score : scores) {
    const Score own = choose(score, rows);
    const VectorXd left = own.gradient + own.information * error;
    chi_squared += left.dot(own.information.ldlt().solve(left));
  }
  const auto freedom = static_cast<double>(rows.size() * (scores.size() - 1));
  const double widening = 1.0 + 3.0 / freedom;
  return std::max(1.0, chi_squared / freedom * widening * widening);
}

}  // namespace

RigErrorRows rowsOf(RigPart part) {
  switch (part) {
    case RigPart::kTranslation:
      return {0, 3};
    case RigPart::kRotation:
      return {3, 3};
    case RigPart::kTimeOffset:
      return {6, 1};
    case RigPart::kReadout:
      return {7, 1};
    case RigPart::kFocalLength:
      return {8, 1};
  }
  return {};
}

RigExplanation explainBy(RigPart part, const std::vector<RigPart>& estimated,
                         const std::deque<RigScore>& scores) {
  std::vector<RigPart> parts = estimated;
  parts.push_back(part);
  const std::vector<int> rows = rowsOf(parts);
  const Score sum = sumOf(scores, rows);
  const VectorXd error = bestError(sum);
  const int count = rowsOf(part).count;
  double cost = 0.0;
  for (const RigScore& score : scores) cost += score.cost;

  RigExplanation result;
  result.part = part;
  result.error = error.tail(count);
  result.size = result.error.norm();
  result.gain = gainOf(sum) - gainOf(sumOf(scores, rowsOf(estimated)));
  result.share = cost > 0.0 ? 0.5 * result.gain / cost : 0.0;
  result.scatter = scatterAbout(error, scores, rows);
  const MatrixXd covariance =
      sum.information.ldlt().solve(MatrixXd::Identity(error.size(), error.size()));
  const VectorXd direction = result.error.normalized();
  const double variance = direction.dot(covariance.bottomRightCorner(count, count) * direction);
  result.deviation = std::sqrt(variance * result.scatter);
  return result;
}

}  // namespace vins::estimator
