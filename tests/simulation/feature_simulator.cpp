#include "simulation/feature_simulator.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "vins_core/option_check.h"

namespace vins::simulation {
namespace {

Eigen::Vector3d uniformIn(const Eigen::AlignedBox3d& box, Random* random) {
  const double x = random->uniform(), y = random->uniform(), z = random->uniform();
  return box.min() + box.sizes().cwiseProduct(Eigen::Vector3d(x, y, z));
}

/// A place on one of the six faces, uniform by area.
Eigen::Vector3d uniformOnFaces(const Eigen::AlignedBox3d& box, Random* random) {
  const Eigen::Vector3d size = box.sizes();
  const Eigen::Vector3d areas(size.y() * size.z(), size.z() * size.x(), size.x() * size.y());
  double pick = random->uniform() * areas.sum();
  int axis = 0;
  while (axis < 2 && pick >= areas[axis]) pick -= areas[axis++];
  Eigen::Vector3d place = uniformIn(box, random);
  place[axis] = random->uniform() < 0.5 ? box.min()[axis] : box.max()[axis];
  return place;
}

/// Cosine of the widest angle from the optical axis within the image; -1 where the corners tell
/// none.
double widestCosine(const camera_model::Camera& camera) {
  const double right = camera.imageSize().width - 1, bottom = camera.imageSize().height - 1;
  double cosine = 1.0;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(right, 0), Eigen::Vector2d(0, bottom),
        Eigen::Vector2d(right, bottom)}) {
    const auto bearing = camera.unproject(corner);
    if (!bearing) return -1.0;
    cosine = std::min(cosine, bearing->z());
  }
  return cosine - 0.01;
}

/// Angle that one pixel spans at a unit bearing [rad/px]: the inverse root of the area that the
/// tangent plane's unit square has in the image.
double angularResolution(const camera_model::Camera& camera, const Eigen::Vector3d& bearing,
                         double fallback) {
  camera_model::ProjectionJacobians jacobians;
  if (!camera.project(bearing, &jacobians)) return fallback;
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = bearing.unitOrthogonal();
  basis.col(1) = bearing.cross(basis.col(0));
  const double area = std::abs((jacobians.J_pixel_point * basis).determinant());
  return area > 0.0 ? 1.0 / std::sqrt(area) : fallback;
}

}  // namespace

/// What the camera sees at one time: a pixel for each landmark, or nothing.
struct FeatureSimulator::View {
  double t_s;
  std::vector<std::optional<Eigen::Vector2d>> pixels;
};

void FeatureSimulatorOptions::validate() const {
  requireWithin("simulated features", "start", start, {0.0, 1e6});
  requireWithin("simulated features", "duration", duration, {0.0, 1e6});
  requireWithin("simulated features", "image rate", image_rate, {0.1, 1000.0});
  requireWithin("simulated features", "readout", readout, {0.0, 0.2});
  requireWithin("simulated features", "max features", max_features, {0, 10000});
  requireWithin("simulated features", "min distance", min_distance, {0.0, 1000.0});
  requireWithin("simulated features", "border", border, {0.0, 1000.0});
  requireWithin("simulated features", "pixel noise", pixel_noise, {0.0, 100.0});
  requireWithin("simulated features", "loss probability", loss_probability, {0.0, 1.0});
  requireWithin("simulated features", "outlier ratio", outlier_ratio, {0.0, 1.0});
  requireWithin("simulated features", "outlier deviation", outlier_deviation, {0.0, 1000.0});
  requireWithin("simulated features", "landmarks", landmarks, {0, 1000000});
  requireWithin("simulated features", "clutter", clutter, {0.0, 1.0});
  requireWithin("simulated features", "margin", margin, {0.1, 1000.0});
  requireWithin("simulated features", "min depth", min_depth, {0.01, 1000.0});
  requireWithin("simulated features", "moving fraction", moving_fraction, {0.0, 1.0});
  requireWithin("simulated features", "moving amplitude", moving_amplitude, {0.0, 1000.0});
}

std::ostream& operator<<(std::ostream& out, const FeatureSimulatorOptions& options) {
  return out << "frames: from " << options.start << " s for " << options.duration << " s at "
             << options.image_rate << " Hz, read out in " << options.readout << " s, seed "
             << options.seed << "\n"
             << "tracks: " << options.max_features << ", " << options.min_distance
             << " px apart, lost with probability " << options.loss_probability << "\n"
             << "noise: " << options.pixel_noise << " px; outliers: " << options.outlier_ratio
             << " of " << options.outlier_deviation << " px\n"
             << "landmarks: " << options.landmarks << ", " << options.clutter
             << " of them off the walls, which are " << options.margin << " m away; "
             << options.moving_fraction << " swing by " << options.moving_amplitude << " m\n";
}

FeatureSimulator::FeatureSimulator(TrajectorySpline motion,
                                   std::shared_ptr<const camera_model::Camera> camera,
                                   const Pose& T_bc, const FeatureSimulatorOptions& options)
    : motion_(std::move(motion)),
      camera_(std::move(camera)),
      T_bc_(T_bc),
      options_(options),
      noise_(options.seed, "feature noise"),
      losses_(options.seed, "feature losses"),
      outliers_(options.seed, "feature outliers"),
      starts_(options.seed, "feature starts") {
  options_.validate();
  widest_cosine_ = widestCosine(*camera_);
  makeRoom();
  makeLandmarks();
}

void FeatureSimulator::makeRoom() {
  constexpr double kStep = 0.1;
  for (double t = 0.0; t < options_.duration; t += kStep) {
    room_.extend(motion_.poseAt(options_.start + t).position);
  }
  room_.extend(motion_.poseAt(options_.start + options_.duration).position);
  room_.min() -= Eigen::Vector3d::Constant(options_.margin);
  room_.max() += Eigen::Vector3d::Constant(options_.margin);
}

void FeatureSimulator::makeLandmarks() {
  Random places(options_.seed, "feature landmarks");
  Random swings(options_.seed, "feature swings");
  for (int i = 0; i < options_.landmarks; ++i) {
    Landmark landmark;
    const bool on_wall = places.uniform() >= options_.clutter;
    landmark.position_w = on_wall ? uniformOnFaces(room_, &places) : uniformIn(room_, &places);
    const bool swings_about = swings.uniform() < options_.moving_fraction;
    const Eigen::Vector3d direction = swings.normal3().normalized();
    landmark.frequency = 2.0 * M_PI / swings.uniform(4.0, 10.0);
    landmark.phase = swings.uniform(0.0, 2.0 * M_PI);
    if (swings_about) landmark.swing_w = options_.moving_amplitude * direction;
    landmarks_.push_back(landmark);
  }
}

Eigen::Vector3d FeatureSimulator::Landmark::at(double t_s) const {
  if (swing_w.isZero(0.0)) return position_w;
  return position_w + std::sin(frequency * t_s + phase) * swing_w;
}

std::optional<Eigen::Vector2d> FeatureSimulator::pixelOf(const Eigen::Vector3d& p_c) const {
  const double distance = p_c.norm();
  if (distance < options_.min_depth || p_c.z() < widest_cosine_ * distance) return std::nullopt;
  const auto pixel = camera_->project(p_c);
  return pixel && camera_->contains(*pixel, options_.border) ? pixel : std::nullopt;
}

std::optional<Eigen::Vector2d> FeatureSimulator::pixelInItsRow(
    const Landmark& landmark, double t_s, const Eigen::Vector2d& first_row) const {
  constexpr int kRounds = 3;  // each leaves a few hundredths of the error before
  std::optional<Eigen::Vector2d> pixel = first_row;
  for (int i = 0; i < kRounds && pixel; ++i) {
    const double late = options_.readout * pixel->y() / camera_->imageSize().height;
    const double t_row = std::min(t_s + late, options_.start + options_.duration);
    pixel = pixelOf((motion_.poseAt(t_row) * T_bc_).inverse() * landmark.at(t_row));
  }
  return pixel;
}

FeatureSimulator::View FeatureSimulator::look(double t_s) const {
  const Pose T_cw = (motion_.poseAt(t_s) * T_bc_).inverse();
  const Eigen::Matrix3d R_cw = T_cw.rotation.toRotationMatrix();
  View view{t_s, std::vector<std::optional<Eigen::Vector2d>>(landmarks_.size())};
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    std::optional<Eigen::Vector2d> pixel = pixelOf(R_cw * landmarks_[i].at(t_s) + T_cw.position);
    if (pixel && options_.readout > 0.0) pixel = pixelInItsRow(landmarks_[i], t_s, *pixel);
    view.pixels[i] = pixel;
  }
  return view;
}

Eigen::Vector2d FeatureSimulator::measure(const Eigen::Vector2d& true_pixel) {
  // Both streams are always drawn from, so that an outlier leaves the noise of others as it is.
  const double x = noise_.normal(), y = noise_.normal();
  const bool is_outlier = outliers_.uniform() < options_.outlier_ratio;
  const double dx = outliers_.normal(), dy = outliers_.normal();
  Eigen::Vector2d pixel = true_pixel + options_.pixel_noise * Eigen::Vector2d(x, y);
  if (is_outlier) pixel += options_.outlier_deviation * Eigen::Vector2d(dx, dy);
  return pixel;
}

std::optional<FeatureObservation> FeatureSimulator::observe(const View& view, Track* track) {
  const auto& true_pixel = view.pixels[track->landmark];
  if (!true_pixel) return std::nullopt;
  FeatureObservation observation;
  observation.id = track->id;
  observation.pixel = measure(*true_pixel);
  const auto bearing = camera_->unproject(observation.pixel);
  if (!bearing || !camera_->contains(observation.pixel)) return std::nullopt;
  observation.bearing = *bearing;
  observation.track_length = ++track->length;
  if (observation.hasVelocity()) {
    observation.bearing_velocity = (*bearing - track->bearing) * options_.image_rate;
  }
  observation.angular_resolution =
      angularResolution(*camera_, *bearing, observation.angular_resolution);
  track->bearing = *bearing;
  return observation;
}

void FeatureSimulator::continueTracks(const View& view, FeatureFrame* frame) {
  std::vector<Track> kept;
  for (Track& track : tracks_) {
    if (losses_.uniform() < options_.loss_probability) continue;
    const auto observation = observe(view, &track);
    if (!observation) continue;
    kept.push_back(track);
    frame->observations.push_back(*observation);
  }
  tracks_ = std::move(kept);
}

std::vector<std::size_t> FeatureSimulator::candidates(const View& view) {
  std::vector<bool> is_tracked(landmarks_.size(), false);
  for (const Track& track : tracks_) is_tracked[track.landmark] = true;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    if (view.pixels[i] && !is_tracked[i]) found.push_back(i);
  }
  // Fisher and Yates; the standard leaves std::shuffle to the library.
  for (std::size_t i = found.size(); i > 1; --i) std::swap(found[i - 1], found[starts_.bits() % i]);
  return found;
}

void FeatureSimulator::startTracks(const View& view, FeatureFrame* frame) {
  const auto wanted = static_cast<std::size_t>(options_.max_features);
  if (tracks_.size() >= wanted) return;
  const double least = options_.min_distance * options_.min_distance;
  for (const std::size_t landmark : candidates(view)) {
    if (tracks_.size() >= wanted) return;
    const Eigen::Vector2d& pixel = *view.pixels[landmark];
    const bool is_near = std::any_of(frame->observations.begin(), frame->observations.end(),
                                     [&](const FeatureObservation& other) {
                                       return (other.pixel - pixel).squaredNorm() < least;
                                     });
    if (is_near) continue;
    Track track{static_cast<std::int64_t>(landmark_of_id_.size()), landmark, 0, {}};
    const auto observation = observe(view, &track);
    if (!observation) continue;
    landmark_of_id_.push_back(landmark);
    tracks_.push_back(track);
    frame->observations.push_back(*observation);
  }
}

std::optional<FeatureFrame> FeatureSimulator::next() {
  const double t = frame_ / options_.image_rate;
  if (t > options_.duration) return std::nullopt;
  FeatureFrame frame;
  frame.stamp = motion_.epoch() + toNanoseconds(options_.start + t);
  frame.sequence = frame_++;
  const View view = look(motion_.secondsAt(frame.stamp));
  continueTracks(view, &frame);
  startTracks(view, &frame);
  return frame;
}

std::vector<FeatureFrame> FeatureSimulator::rest() {
  std::vector<FeatureFrame> frames;
  while (auto frame = next()) frames.push_back(std::move(*frame));
  return frames;
}

std::optional<Eigen::Vector3d> FeatureSimulator::positionOf(std::int64_t id, Stamp stamp) const {
  if (id < 0 || id >= static_cast<std::int64_t>(landmark_of_id_.size())) return std::nullopt;
  return landmarks_[landmark_of_id_[static_cast<std::size_t>(id)]].at(motion_.secondsAt(stamp));
}

}  // namespace vins::simulation
