#include "vins_estimator/initialization/initial_landmarks.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vins::estimator {
namespace {

/// Keeps the tracks with most sightings; among equals those that began first.
void keepLongest(std::size_t max_tracks, std::vector<InitialTrack>* tracks) {
  if (tracks->size() <= max_tracks) return;
  std::stable_sort(tracks->begin(), tracks->end(), [](const auto& a, const auto& b) {
    return a.sightings.size() > b.sightings.size();
  });
  tracks->resize(max_tracks);
  std::sort(tracks->begin(), tracks->end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
}

double squaredResidual(const InitialLandmark& landmark, std::size_t sighting, const Pose& T_bc,
                       const InitialBlocks& blocks) {
  const InitialLandmark::Sighting& seen = landmark.sightings[sighting];
  if (sighting == 0) {
    double residual[2];
    const double* parameters[] = {landmark.parameters.data()};
    HostBearingFactor(seen.measured, landmark.anchor).Evaluate(parameters, residual, nullptr);
    return residual[0] * residual[0] + residual[1] * residual[1];
  }
  const ViewGeometry host = viewGeometry(toPose(blocks.poses[landmark.host()].data()), T_bc);
  const ViewGeometry target = viewGeometry(toPose(blocks.poses[seen.frame].data()), T_bc);
  return bearingResidual(seen.measured, landmark.anchor, host, target, landmark.parameters, nullptr)
      .squaredNorm();
}

}  // namespace

const FeatureObservation* InitialTrack::in(std::size_t frame) const {
  for (const Sighting& sighting : sightings) {
    if (sighting.frame == frame) return sighting.observation;
  }
  return nullptr;
}

std::vector<InitialTrack> collectTracks(const std::vector<const FeatureFrame*>& frames,
                                        std::size_t max_tracks) {
  std::map<std::int64_t, InitialTrack> by_id;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (const FeatureObservation& observation : frames[i]->observations) {
      if (observation.camera != 0) continue;
      InitialTrack& track = by_id[observation.id];
      track.id = observation.id;
      track.sightings.push_back({i, &observation});
    }
  }
  std::vector<InitialTrack> tracks;
  for (auto& [id, track] : by_id) {
    if (track.sightings.size() >= 2) tracks.push_back(std::move(track));
  }
  keepLongest(max_tracks, &tracks);
  return tracks;
}

BearingMeasurement toMeasurement(const FeatureObservation& observation, double pixel_noise) {
  BearingMeasurement measured;
  measured.bearing = observation.bearing;
  measured.basis = tangentBasis(observation.bearing);
  measured.inverse_sigma = 1.0 / (pixel_noise * observation.angular_resolution);
  return measured;
}

InitialBlocks::InitialBlocks(const std::vector<NavState>& values) {
  for (const NavState& value : values) {
    states.emplace_back(value);
    poses.push_back(toPoseBlock(value.T_wb));
    motions.push_back(toMotionBlock(value));
  }
}

std::vector<NavState> InitialBlocks::values() const {
  std::vector<NavState> result;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    result.push_back(toNavState(poses[i].data(), motions[i].data()));
  }
  return result;
}

std::vector<ceres::ResidualBlockId> addLandmarkResiduals(const Pose& T_bc,
                                                         ceres::LossFunction* loss,
                                                         InitialBlocks* blocks,
                                                         std::vector<InitialLandmark>* landmarks,
                                                         ceres::Problem* problem,
                                                         ceres::ParameterBlockOrdering* ordering) {
  std::vector<ceres::ResidualBlockId> ids;
  for (InitialLandmark& landmark : *landmarks) {
    double* parameters = landmark.parameters.data();
    const std::size_t host = landmark.host();
    for (std::size_t k = 0; k < landmark.sightings.size(); ++k) {
      const auto& seen = landmark.sightings[k];
      if (k == 0) {
        auto* factor = new HostBearingFactor(seen.measured, landmark.anchor);
        ids.push_back(problem->AddResidualBlock(factor, loss, parameters));
        continue;
      }
      auto* factor = new BearingFactor(seen.measured, landmark.anchor, T_bc, blocks->states[host],
                                       blocks->states[seen.frame]);
      ids.push_back(problem->AddResidualBlock(factor, loss, blocks->poses[host].data(),
                                              blocks->poses[seen.frame].data(), parameters));
    }
    ordering->AddElementToGroup(parameters, 0);
  }
  return ids;
}

double sightingResidual(const InitialLandmark& landmark, std::size_t sighting, const Pose& T_bc,
                        const InitialBlocks& blocks) {
  return std::sqrt(squaredResidual(landmark, sighting, T_bc, blocks));
}

int removeOutliers(double gate, const Pose& T_bc, const InitialBlocks& blocks,
                   std::vector<InitialLandmark>* landmarks) {
  int removed = 0;
  std::vector<InitialLandmark> kept;
  for (InitialLandmark& landmark : *landmarks) {
    std::vector<InitialLandmark::Sighting> good;
    const bool host_is_good =
        landmark.parameters.z() > 0.0 && sightingResidual(landmark, 0, T_bc, blocks) <= gate;
    for (std::size_t k = 0; host_is_good && k < landmark.sightings.size(); ++k) {
      const double residual = sightingResidual(landmark, k, T_bc, blocks);
      if (residual <= gate) good.push_back(landmark.sightings[k]);
    }
    const bool keep = good.size() >= 2;
    removed += static_cast<int>(landmark.sightings.size() - (keep ? good.size() : 0));
    if (!keep) continue;
    landmark.sightings = std::move(good);
    kept.push_back(std::move(landmark));
  }
  *landmarks = std::move(kept);
  return removed;
}

double landmarkSquares(const Pose& T_bc, const InitialBlocks& blocks,
                       const std::vector<InitialLandmark>& landmarks) {
  double squares = 0.0;
  for (const InitialLandmark& landmark : landmarks) {
    for (std::size_t k = 0; k < landmark.sightings.size(); ++k) {
      squares += squaredResidual(landmark, k, T_bc, blocks);
    }
  }
  return squares;
}

double landmarkRms(const Pose& T_bc, const InitialBlocks& blocks,
                   const std::vector<InitialLandmark>& landmarks) {
  double degrees = 0.0;
  for (const InitialLandmark& landmark : landmarks) {
    degrees += 2.0 * static_cast<double>(landmark.sightings.size()) - 3.0;
  }
  return std::sqrt(landmarkSquares(T_bc, blocks, landmarks) / std::max(1.0, degrees));
}

}  // namespace vins::estimator
