#pragma once

#include <optional>

#include "vins_core/loop_match.h"
#include "vins_estimator/window/sliding_window.h"
#include "vins_estimator/window/window_solver.h"

namespace vins::estimator {

/// Takes a verified loop into the window, in place of an earlier one: what the old keyframe saw of
/// the window's tracks becomes measurements. `match_noise`: deviation of a feature that was found
/// again by its looks, in deviations of a tracked one. False, and nothing changed, where the query
/// is not (or no longer) in the window or none of the features is.
bool addLoop(const LoopMatch& match, double match_noise, SlidingWindow* window);

/// The loop as an edge for the pose graph, after a solution; nothing where too few matches are
/// left that agree.
std::optional<LoopEdge> loopEdge(const SlidingWindow& window, const LoopEstimate& estimate,
                                 int min_inliers);

/// Forgets the loop where fewer matches than that are left whose landmarks have a depth: in a fast
/// turn the landmarks go before their keyframe does, and the old one would hang in the air.
void forgetFadedLoop(int min_matches, SlidingWindow* window);

/// Forgets the loop if its query keyframe is the oldest frame, which is about to go.
void forgetLeavingLoop(SlidingWindow* window);

}  // namespace vins::estimator
