#include "graph_picture.h"

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <opencv2/imgproc.hpp>

namespace vins::pose_graph {
namespace {

constexpr int kPanel = 900;  // width and height of a panel [px]
constexpr int kMargin = 40;  // [px]
constexpr int kShift = 4;    // fractional bits of drawn coordinates

using View = Eigen::Matrix<double, 2, 3>;

/// Axes of the two widest directions of the positions, the first axis pointing right.
View viewOf(const RelativePoseGraph& graph) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const GraphPose& pose : graph.poses) mean += pose.T_wi.position;
  mean /= static_cast<double>(graph.poses.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const GraphPose& pose : graph.poses) {
    const Eigen::Vector3d d = pose.T_wi.position - mean;
    covariance += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  View view;
  view.row(0) = solver.eigenvectors().col(2).transpose();
  view.row(1) = solver.eigenvectors().col(1).transpose();
  for (int k = 0; k < 2; ++k) {
    Eigen::Index largest = 0;
    view.row(k).cwiseAbs().maxCoeff(&largest);
    if (view(k, largest) < 0.0) view.row(k) *= -1.0;
  }
  return view;
}

/// Where the poses stand in a panel [px], y down.
std::vector<Eigen::Vector2d> placeInPanel(const RelativePoseGraph& graph, const View& view) {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(INFINITY), high = -low;
  for (const GraphPose& pose : graph.poses) {
    points.emplace_back(view * pose.T_wi.position);
    low = low.cwiseMin(points.back());
    high = high.cwiseMax(points.back());
  }
  const double size = std::max((high - low).maxCoeff(), 1e-12);
  const double scale = (kPanel - 2 * kMargin) / size;
  const Eigen::Vector2d middle = 0.5 * (low + high);
  for (Eigen::Vector2d& point : points) {
    const Eigen::Vector2d d = scale * (point - middle);
    point = {0.5 * kPanel + d.x(), 0.5 * kPanel - d.y()};
  }
  return points;
}

void drawEdges(const GraphTopology& topology, const std::vector<Eigen::Vector2d>& points,
               bool neighbours, const cv::Scalar& colour, cv::Mat* panel) {
  const auto fixed_point = [&points](int i) {
    const Eigen::Vector2d p = points[static_cast<std::size_t>(i)] * (1 << kShift);
    return cv::Point(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  };
  for (std::size_t k = 0; k < topology.from.size(); ++k) {
    const int i = topology.from[k], j = topology.to[k];
    if ((std::abs(i - j) == 1) != neighbours) continue;
    cv::line(*panel, fixed_point(i), fixed_point(j), colour, 1, cv::LINE_AA, kShift);
  }
}

cv::Mat drawPanel(const RelativePoseGraph& graph, const View& view, const std::string& title) {
  cv::Mat panel(kPanel, kPanel, CV_8UC3, cv::Scalar::all(255));
  const GraphTopology topology(graph);
  const std::vector<Eigen::Vector2d> points = placeInPanel(graph, view);
  drawEdges(topology, points, false, {120, 170, 250}, &panel);
  drawEdges(topology, points, true, {120, 50, 20}, &panel);
  cv::putText(panel, title, {kMargin, kMargin - 12}, cv::FONT_HERSHEY_SIMPLEX, 0.7, {0, 0, 0}, 1,
              cv::LINE_AA);
  return panel;
}

}  // namespace

cv::Mat drawGraphs(const RelativePoseGraph& before, const RelativePoseGraph& after) {
  const View view = viewOf(after);
  cv::Mat picture;
  cv::hconcat(drawPanel(before, view, "before"), drawPanel(after, view, "after"), picture);
  return picture;
}

}  // namespace vins::pose_graph
