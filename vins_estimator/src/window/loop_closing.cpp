#include "vins_estimator/window/loop_closing.h"

#include <algorithm>

namespace vins::estimator {
namespace {

const WindowFrame* findKeyframe(const SlidingWindow& window, std::int64_t keyframe_id) {
  const auto it = std::find_if(window.frames.begin(), window.frames.end(),
                               [&](const auto& f) { return f.keyframe_id == keyframe_id; });
  return it == window.frames.end() ? nullptr : &*it;
}

/// Weight of a feature of the track that was found again in another image.
double inverseSigma(const Landmark& track, double match_noise) {
  return track.observations.back().measured.inverse_sigma / match_noise;
}

/// Matches whose landmarks are still in the window.
int countMatches(const SlidingWindow& window) {
  const auto& tracks = window.landmarks.tracks();
  return static_cast<int>(std::count_if(window.loop->measured.begin(), window.loop->measured.end(),
                                        [&tracks](const auto& match) {
                                          const auto track = tracks.find(match.first);
                                          return track != tracks.end() && track->second.has_depth;
                                        }));
}

}  // namespace

bool addLoop(const LoopMatch& match, double match_noise, SlidingWindow* window) {
  const WindowFrame* query = findKeyframe(*window, match.query_id);
  if (query == nullptr) return false;
  OldKeyframe old;
  old.keyframe_id = match.old_id;
  old.query_id = match.query_id;
  // The old camera counts; the body is the one that the window's calibration hangs on it.
  const Pose T_old_body = match.T_bc_old * window->rig.T_bc.inverse();
  old.T_wb = window->atImage(*query).T_wb * match.T_old_query.inverse() * T_old_body;
  old.up_b = (match.T_wb_old * T_old_body).rotation.conjugate() * Eigen::Vector3d::UnitZ();
  for (const MatchedFeature& feature : match.features) {
    const auto track = window->landmarks.tracks().find(feature.id);
    if (track == window->landmarks.tracks().end()) continue;
    BearingMeasurement measured;
    measured.bearing = feature.bearing_old.normalized();
    measured.basis = tangentBasis(measured.bearing);
    measured.inverse_sigma = inverseSigma(track->second, match_noise);
    old.measured.emplace(feature.id, measured);
  }
  if (old.measured.empty()) return false;
  old.T_body_old = T_old_body.inverse();
  window->loop = std::move(old);
  return true;
}

std::optional<LoopEdge> loopEdge(const SlidingWindow& window, const LoopEstimate& estimate,
                                 int min_inliers) {
  const int inliers = countMatches(window);
  if (inliers < min_inliers) return std::nullopt;
  LoopEdge edge;
  edge.query_id = window.loop->query_id;
  edge.old_id = window.loop->keyframe_id;
  edge.query_stamp = findKeyframe(window, edge.query_id)->stamp;
  edge.T_old_query = window.loop->T_body_old.inverse() * estimate.T_old_query;
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Identity();
  turn.topLeftCorner<3, 3>() = window.loop->T_body_old.rotation.conjugate().toRotationMatrix();
  edge.covariance = turn * estimate.covariance * turn.transpose();
  edge.inliers = inliers;
  return edge;
}

void forgetFadedLoop(int min_matches, SlidingWindow* window) {
  if (window->loop && countMatches(*window) < min_matches) window->loop.reset();
}

void forgetLeavingLoop(SlidingWindow* window) {
  if (window->loop && window->frames.front().keyframe_id == window->loop->query_id) {
    window->loop.reset();
  }
}

}  // namespace vins::estimator
