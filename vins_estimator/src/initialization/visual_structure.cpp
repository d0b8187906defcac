#include "vins_estimator/initialization/visual_structure.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "vins_core/option_check.h"
#include "vins_core/time.h"
#include "vins_estimator/initialization/structure_adjustment.h"
#include "vins_estimator/visual/triangulation.h"

namespace vins::estimator {
namespace {

/// The newest frame and an older one.
struct FramePair {
  std::size_t older = 0;
  std::vector<BearingPair> bearings;  ///< of the shared tracks
  std::vector<std::size_t> tracks;    ///< their indices
  double parallax = 0.0;              ///< compensated by the gyroscope [px]
  double own_parallax = 0.0;          ///< what the best rotation leaves [px]
};

class StructureBuilder {
 public:
  StructureBuilder(const std::vector<StructureFrame>& frames, double pixel_noise,
                   const VisualStructureOptions& options, std::uint64_t seed);

  VisualStructure build();

 private:
  FramePair pairWith(std::size_t older) const;
  std::vector<FramePair> choosePairs();
  std::vector<RelativePose> relativePoses(const FramePair& pair, std::uint64_t seed) const;
  VisualStructure buildFrom(const FramePair& pair, const RelativePose& relative);
  void begin(const FramePair& pair, const RelativePose& relative);
  bool resectOthers(std::size_t older);
  bool resect(std::size_t frame, std::size_t neighbour, const Eigen::Vector3d& position);
  void triangulateTracks();
  std::vector<InitialLandmark> landmarks() const;
  void adjust(VisualStructure* structure) const;
  Eigen::Quaterniond gyroRotation(std::size_t from, std::size_t to) const;

  const std::vector<StructureFrame>& frames_;
  const double pixel_noise_;
  const VisualStructureOptions& options_;
  const std::uint64_t seed_;
  std::vector<InitialTrack> tracks_;
  std::vector<std::optional<Pose>> T_sc_;               ///< one for each frame
  std::vector<std::optional<Eigen::Vector3d>> points_;  ///< one for each track
  VisualStructure result_;
};

std::vector<const FeatureFrame*> featuresOf(const std::vector<StructureFrame>& frames) {
  std::vector<const FeatureFrame*> features;
  for (const StructureFrame& frame : frames) features.push_back(frame.features);
  return features;
}

StructureBuilder::StructureBuilder(const std::vector<StructureFrame>& frames, double pixel_noise,
                                   const VisualStructureOptions& options, std::uint64_t seed)
    : frames_(frames),
      pixel_noise_(pixel_noise),
      options_(options),
      seed_(seed),
      tracks_(collectTracks(featuresOf(frames), static_cast<std::size_t>(options.max_tracks))) {}

Eigen::Quaterniond StructureBuilder::gyroRotation(std::size_t from, std::size_t to) const {
  return frames_[from].R_c0_c.conjugate() * frames_[to].R_c0_c;
}

FramePair StructureBuilder::pairWith(std::size_t older) const {
  const std::size_t newest = frames_.size() - 1;
  FramePair pair;
  pair.older = older;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const FeatureObservation* first = tracks_[i].in(older);
    const FeatureObservation* second = tracks_[i].in(newest);
    if (first == nullptr || second == nullptr) continue;
    const double sigma = pixel_noise_ * second->angular_resolution;
    pair.bearings.push_back({first->bearing, second->bearing, sigma});
    pair.tracks.push_back(i);
  }
  return pair;
}

/// Those with enough parallax, the oldest first. Sets the figures of the result.
std::vector<FramePair> StructureBuilder::choosePairs() {
  std::vector<FramePair> pairs;
  result_.status = StructureStatus::kFewTracks;
  for (std::size_t older = 0; older + 1 < frames_.size(); ++older) {
    FramePair pair = pairWith(older);
    const auto shared = static_cast<int>(pair.bearings.size());
    if (result_.status == StructureStatus::kFewTracks) {
      result_.shared = std::max(result_.shared, shared);
    }
    if (shared <= options_.min_shared) continue;
    const Eigen::Quaterniond R_gyro = gyroRotation(older, frames_.size() - 1);
    pair.parallax = pixel_noise_ * medianParallax(pair.bearings, R_gyro);
    pair.own_parallax =
        pixel_noise_ * medianParallax(pair.bearings, fitRotation(pair.bearings, R_gyro));
    result_.status = StructureStatus::kLittleParallax;
    if (pair.own_parallax > result_.own_parallax) {
      result_.shared = shared;
      result_.parallax = pair.parallax;
      result_.own_parallax = pair.own_parallax;
    }
    if (pair.parallax < options_.min_parallax || pair.own_parallax < options_.min_own_parallax) {
      continue;
    }
    pairs.push_back(std::move(pair));
    if (static_cast<int>(pairs.size()) == options_.max_pairs) break;
  }
  return pairs;
}

std::vector<RelativePose> StructureBuilder::relativePoses(const FramePair& pair,
                                                          std::uint64_t seed) const {
  const std::size_t newest = frames_.size() - 1;
  const double duration =
      toSeconds(frames_[newest].features->stamp - frames_[pair.older].features->stamp);
  const double max_angle = options_.rotation_tolerance + options_.max_gyroscope_bias * duration;
  return findRelativePoses(pair.bearings, gyroRotation(pair.older, newest), max_angle,
                           options_.relative_pose, seed);
}

void StructureBuilder::begin(const FramePair& pair, const RelativePose& relative) {
  T_sc_.assign(frames_.size(), std::nullopt);
  points_.assign(tracks_.size(), std::nullopt);
  T_sc_[pair.older] = Pose();
  T_sc_.back() = relative.T_12;
  triangulateTracks();
  // What the pair's epipolar geometry rejects is no point, though its rays may pass by chance.
  for (std::size_t i = 0; i < pair.tracks.size(); ++i) {
    if (!relative.inliers[i]) points_[pair.tracks[i]].reset();
  }
}

/// Triangulates the tracks without a point from the frames whose pose is known.
void StructureBuilder::triangulateTracks() {
  TriangulationOptions triangulation;
  triangulation.min_parallax = 3.0 * pixel_noise_ / 460.0;  // three deviations of a usual camera
  triangulation.max_rms = options_.outlier_gate;
  triangulation.min_distance = 1e-3;
  std::vector<TriangulationView> views;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (points_[i]) continue;
    views.clear();
    for (const auto& [frame, observation] : tracks_[i].sightings) {
      if (!T_sc_[frame]) continue;
      views.push_back({*T_sc_[frame], observation->bearing,
                       1.0 / (pixel_noise_ * observation->angular_resolution)});
    }
    const Triangulation found = triangulate(views, triangulation);
    if (found.ok()) points_[i] = found.position_w;
  }
}

bool StructureBuilder::resect(std::size_t frame, std::size_t neighbour,
                              const Eigen::Vector3d& position) {
  std::vector<PointSighting> sightings;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const FeatureObservation* observation = points_[i] ? tracks_[i].in(frame) : nullptr;
    if (observation == nullptr) continue;
    sightings.push_back({*points_[i], observation->bearing,
                         1.0 / (pixel_noise_ * observation->angular_resolution)});
  }
  const Pose start(T_sc_[neighbour]->rotation * gyroRotation(neighbour, frame), position);
  T_sc_[frame] = resectCamera(sightings, start, options_.resection);
  if (!T_sc_[frame]) return false;
  triangulateTracks();
  return true;
}

/// From the older frame of the pair to the newest, then back to the first.
bool StructureBuilder::resectOthers(std::size_t older) {
  const std::size_t newest = frames_.size() - 1;
  for (std::size_t k = older + 1; k < newest; ++k) {
    const double share = 1.0 / static_cast<double>(newest - k + 1);
    const Eigen::Vector3d& last = T_sc_[k - 1]->position;
    if (!resect(k, k - 1, last + share * (T_sc_[newest]->position - last))) return false;
  }
  for (std::size_t k = older; k-- > 0;) {
    const Eigen::Vector3d& next = T_sc_[k + 1]->position;
    if (!resect(k, k + 1, next + (next - T_sc_[k + 2]->position))) return false;
  }
  return true;
}

/// Landmarks of the tracks with a point, in the frame of the first camera.
std::vector<InitialLandmark> StructureBuilder::landmarks() const {
  std::vector<InitialLandmark> landmarks;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!points_[i]) continue;
    InitialLandmark landmark;
    landmark.id = tracks_[i].id;
    for (const auto& [frame, observation] : tracks_[i].sightings) {
      landmark.sightings.push_back({frame, toMeasurement(*observation, pixel_noise_)});
    }
    landmark.anchor = {landmark.sightings.front().measured.bearing,
                       landmark.sightings.front().measured.basis};
    const Eigen::Vector3d in_host = T_sc_[landmark.host()]->inverse() * *points_[i];
    const double along = in_host.dot(landmark.anchor.bearing);
    if (!(along > 0.0)) continue;
    landmark.parameters << landmark.anchor.basis.transpose() * in_host / along, 1.0 / along;
    landmarks.push_back(std::move(landmark));
  }
  return landmarks;
}

void StructureBuilder::adjust(VisualStructure* structure) const {
  structure->landmarks = landmarks();
  const Pose T_cs = T_sc_.front()->inverse();
  for (const auto& T_sc : T_sc_) structure->T_sc.push_back(T_cs * *T_sc);
  const StructureAdjustment adjustment = adjustStructure(
      options_.max_iterations, options_.outlier_gate, &structure->T_sc, &structure->landmarks);
  structure->rms = adjustment.rms;
  const bool good = adjustment.usable && adjustment.rms <= options_.max_rms &&
                    static_cast<int>(structure->landmarks.size()) >= options_.min_landmarks;
  structure->status = good ? StructureStatus::kOk : StructureStatus::kBadAdjustment;
}

VisualStructure StructureBuilder::buildFrom(const FramePair& pair, const RelativePose& relative) {
  VisualStructure structure;
  structure.shared = static_cast<int>(pair.bearings.size());
  structure.parallax = pair.parallax;
  structure.own_parallax = pair.own_parallax;
  structure.status = StructureStatus::kLostFrame;
  begin(pair, relative);
  if (resectOthers(pair.older)) adjust(&structure);
  return structure;
}

VisualStructure StructureBuilder::build() {
  std::uint64_t seed = seed_;
  for (const FramePair& pair : choosePairs()) {
    const std::vector<RelativePose> relative_poses = relativePoses(pair, seed++);
    if (relative_poses.empty() && !result_.ok()) result_.status = StructureStatus::kNoRelativePose;
    for (const RelativePose& relative : relative_poses) {
      VisualStructure structure = buildFrom(pair, relative);
      const bool better = structure.ok() && (!result_.ok() || structure.rms < result_.rms);
      if (better || !result_.ok()) result_ = std::move(structure);
    }
    if (result_.ok()) break;
  }
  if (!result_.ok()) {
    result_.T_sc.clear();
    result_.landmarks.clear();
  }
  return std::move(result_);
}

}  // namespace

void VisualStructureOptions::validate() const {
  const std::pair<const char*, double> positive[] = {{"min_shared", min_shared},
                                                     {"min_parallax", min_parallax},
                                                     {"min_own_parallax", min_own_parallax},
                                                     {"max_gyroscope_bias", max_gyroscope_bias},
                                                     {"rotation_tolerance", rotation_tolerance},
                                                     {"max_pairs", max_pairs},
                                                     {"max_tracks", max_tracks},
                                                     {"outlier_gate", outlier_gate},
                                                     {"max_rms", max_rms},
                                                     {"min_landmarks", min_landmarks},
                                                     {"max_iterations", max_iterations}};
  for (const auto& [name, value] : positive) {
    requirePositive("visual structure", name, value);
  }
  relative_pose.validate();
  resection.validate();
}

const char* toString(StructureStatus status) {
  switch (status) {
    case StructureStatus::kOk:
      return "ok";
    case StructureStatus::kFewTracks:
      return "few tracks";
    case StructureStatus::kLittleParallax:
      return "little parallax";
    case StructureStatus::kNoRelativePose:
      return "no relative pose";
    case StructureStatus::kLostFrame:
      return "lost frame";
    case StructureStatus::kBadAdjustment:
      return "bad adjustment";
  }
  return "unknown";
}

VisualStructure buildStructure(const std::vector<StructureFrame>& frames, double pixel_noise,
                               const VisualStructureOptions& options, std::uint64_t seed) {
  if (frames.size() < 2) return {};
  return StructureBuilder(frames, pixel_noise, options, seed).build();
}

}  // namespace vins::estimator
