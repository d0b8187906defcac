#include "vins_estimator/window/window_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "vins_estimator/factors/imu_factor.h"
#include "vins_estimator/factors/upright_factor.h"

namespace vins::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Huber's loss of a residual's length.
double robustCost(double huber, double length) {
  return length <= huber ? 0.5 * length * length : huber * (length - 0.5 * huber);
}

}  // namespace

WindowSystem::WindowSystem(const SlidingWindow& window, double huber)
    : window_(window), huber_(huber) {
  std::map<FrameId, std::size_t> index;
  for (std::size_t i = 0; i < window.frames.size(); ++i) index[window.frames[i].id] = i;
  for (const auto& [id, landmark] : window.landmarks.tracks()) {
    if (!landmark.has_depth) continue;
    collectObservations(index, landmark);
  }
  W_.resize(observations_.size());
  eliminations_.resize(landmarks_.size());
  preparePrior();
}

void WindowSystem::collectObservations(const std::map<FrameId, std::size_t>& index,
                                       const Landmark& landmark) {
  const std::size_t begin = observations_.size();
  for (const TrackObservation& observation : landmark.observations) {
    observations_.push_back({&observation.measured, index.at(observation.frame)});
  }
  if (window_.loop) {
    const auto old = window_.loop->measured.find(landmark.id);
    if (old != window_.loop->measured.end()) {
      observations_.push_back({&old->second, frameCount()});
    }
  }
  landmarks_.push_back({&landmark, observations_[begin].target, begin, observations_.size()});
}

WindowSystem::Point WindowSystem::present() const {
  Point point;
  point.values = window_.values();
  for (const FlatLandmark& flat : landmarks_) point.landmarks.push_back(flat.landmark->parameters);
  return point;
}

void WindowSystem::writeTo(const Point& point, SlidingWindow* window) const {
  const WindowValues& values = point.values;
  for (std::size_t i = 0; i < values.states.size(); ++i) {
    window->frames[i].state.setValue(values.states[i]);
  }
  if (window->loop) window->loop->T_wb = values.old.front();
  window->rig = values.rig;
  for (std::size_t k = 0; k < landmarks_.size(); ++k) {
    window->landmarks.tracks().at(landmarks_[k].landmark->id).parameters = point.landmarks[k];
  }
}

Index WindowSystem::motionColumn(std::size_t frame) { return static_cast<Index>(9 * frame); }

Index WindowSystem::poseColumn(std::size_t view) const {
  return static_cast<Index>(9 * frameCount() + 6 * view);
}

Index WindowSystem::stepCount() const { return size() - poseColumn(0); }

Index WindowSystem::column(const Prior::Part& part) const {
  if (part.kind == Prior::Kind::kRig) return rigColumn();
  return part.kind == Prior::Kind::kMotion ? motionColumn(part.frame) : poseColumn(part.frame);
}

void WindowSystem::preparePrior() {
  prior_information_ = MatrixXd::Zero(size(), size());
  const MatrixXd information = window_.prior.A.transpose() * window_.prior.A;
  Index row = 0;
  for (const Prior::Part& a : window_.prior.parts) {
    Index col = 0;
    for (const Prior::Part& b : window_.prior.parts) {
      prior_information_.block(column(a), column(b), a.size(), b.size()) =
          information.block(row, col, a.size(), b.size());
      col += b.size();
    }
    row += a.size();
  }
}

double WindowSystem::bearingCost(const Point& point) const {
  const WindowGeometry geometry = geometryOf(window_, point.values);
  double cost = 0.0;
  for (std::size_t index = 0; index < landmarks_.size(); ++index) {
    const FlatLandmark& flat = landmarks_[index];
    for (std::size_t k = flat.begin; k < flat.end; ++k) {
      const Eigen::Vector2d r =
          observationResidual(*observations_[k].measured, flat.landmark->anchor, geometry,
                              flat.host, observations_[k].target, point.landmarks[index]);
      cost += robustCost(huber_, r.norm());
    }
  }
  return cost;
}

VectorXd WindowSystem::priorResidual(const Point& point) const {
  const Prior& prior = window_.prior;
  VectorXd d(prior.columns());
  Index row = 0;
  for (const Prior::Part& part : prior.parts) {
    d.segment(row, part.size()) =
        priorDifference(part, point.values.states[part.frame], point.values.rig);
    row += part.size();
  }
  return prior.A * d + prior.b;
}

double WindowSystem::cost(const Point& point) const {
  double cost = bearingCost(point);
  const std::vector<NavState>& states = point.values.states;
  for (std::size_t i = 1; i < frameCount(); ++i) {
    const Preintegration& imu = window_.frames[i].imu;
    if (!imu.isWeightable()) return std::numeric_limits<double>::infinity();
    const Vector15d r =
        imuResidual(imu, window_.g_w, states[i - 1], states[i], point.values.rig.imu);
    cost += 0.5 * (imu.sqrtInformation() * r).squaredNorm();
  }
  for (std::size_t i = 0; i < frameCount(); ++i) {
    const WindowFrame& frame = window_.frames[i];
    if (frame.stands_still) cost += 0.5 * (states[i].v_w / window_.rest.velocity).squaredNorm();
    if (!frame.has_rested || i == 0) continue;
    cost +=
        0.5 * zeroMotionResidual(window_.rest, states[i - 1].T_wb, states[i].T_wb, nullptr, nullptr)
                  .squaredNorm();
  }
  if (window_.loop) {
    cost += 0.5 * uprightResidual(window_.loop->up_b, 1.0 / window_.old_tilt,
                                  point.values.old.front().rotation, nullptr)
                      .squaredNorm();
  }
  if (!window_.prior.empty()) cost += 0.5 * priorResidual(point).squaredNorm();
  return cost;
}

bool WindowSystem::linearize(const Point& point) {
  at_ = point;
  geometry_ = geometryOf(window_, point.values);
  H_ = prior_information_;
  g_ = VectorXd::Zero(size());
  for (std::size_t k = 0; k < landmarks_.size(); ++k) addLandmark(k);
  for (std::size_t i = 1; i < frameCount(); ++i) addImu(i);
  for (std::size_t i = 0; i < frameCount(); ++i) addStillness(i);
  for (std::size_t i = 1; i < frameCount(); ++i) addRest(i);
  addOldTilt();
  addPrior();
  llt_.compute(H_);
  if (llt_.info() != Eigen::Success) return false;
  y_ = llt_.matrixL().solve(g_);
  return y_.allFinite();
}

void WindowSystem::addLandmark(std::size_t index) {
  const FlatLandmark& landmark = landmarks_[index];
  Eigen::Matrix3d H_ll = Eigen::Matrix3d::Zero();
  Matrix63d W_host = Matrix63d::Zero();
  Elimination& elimination = eliminations_[index];
  elimination.g.setZero();
  elimination.W_rig.setZero();
  for (std::size_t k = landmark.begin; k < landmark.end; ++k) {
    LinearizedObservation o =
        linearizeObservation(*observations_[k].measured, landmark.landmark->anchor, geometry_,
                             landmark.host, observations_[k].target, at_.landmarks[index]);
    scaleByLoss(huber_, &o);
    H_ll += o.J_landmark.transpose() * o.J_landmark;
    elimination.g += o.J_landmark.transpose() * o.r;
    if (refinesRig() && rigVariables().camera) {
      addRig<kCameraRigSize>(o, landmark.host, &elimination);
    } else if (refinesRig()) {
      addRig<kReadout>(o, landmark.host, &elimination);
    }
    if (k == landmark.begin) continue;
    W_host += o.J_host.transpose() * o.J_landmark;
    W_[k] = o.J_target.transpose() * o.J_landmark;
    addObservation(o, landmark.host);
  }
  W_[landmark.begin] = W_host;
  H_ll.diagonal().array() += kLandmarkDamping;
  elimination.H_inverse = H_ll.inverse();
  eliminate(index);
}

void WindowSystem::addObservation(const LinearizedObservation& o, std::size_t host_view) {
  const Index host = poseColumn(host_view);
  const Index target = poseColumn(o.target);
  H_.block<6, 6>(host, host) += o.J_host.transpose() * o.J_host;
  H_.block<6, 6>(target, target) += o.J_target.transpose() * o.J_target;
  // The lower triangle only; the host stands before every target.
  H_.block<6, 6>(target, host) += o.J_target.transpose() * o.J_host;
  g_.segment<6>(host) += o.J_host.transpose() * o.r;
  g_.segment<6>(target) += o.J_target.transpose() * o.r;
}

template <int columns>
void WindowSystem::addRig(const LinearizedObservation& o, std::size_t host,
                          Elimination* elimination) {
  const Index rig = rigColumn();
  const auto J_rig = o.J_rig.leftCols<columns>();
  H_.block<columns, columns>(rig, rig) += J_rig.transpose() * J_rig;
  H_.block<columns, 6>(rig, poseColumn(host)) += J_rig.transpose() * o.J_host;
  H_.block<columns, 6>(rig, poseColumn(o.target)) += J_rig.transpose() * o.J_target;
  g_.segment<columns>(rig) += J_rig.transpose() * o.r;
  elimination->W_rig.topRows<columns>() += J_rig.transpose() * o.J_landmark;
}

void WindowSystem::eliminate(std::size_t index) {
  const FlatLandmark& landmark = landmarks_[index];
  const Elimination& elimination = eliminations_[index];
  for (std::size_t a = landmark.begin; a < landmark.end; ++a) {
    const Matrix63d left = W_[a] * elimination.H_inverse;
    const Index row = poseColumn(observations_[a].target);
    g_.segment<6>(row) -= left * elimination.g;
    for (std::size_t b = landmark.begin; b <= a; ++b) {
      H_.block<6, 6>(row, poseColumn(observations_[b].target)) -= left * W_[b].transpose();
    }
  }
  if (refinesRig() && rigVariables().camera) {
    eliminateFromRig<kCameraRigSize>(landmark, elimination);
  } else if (refinesRig()) {
    eliminateFromRig<kReadout>(landmark, elimination);
  }
}

template <int columns>
void WindowSystem::eliminateFromRig(const FlatLandmark& landmark, const Elimination& elimination) {
  const Index rig = rigColumn();
  const auto W_rig = elimination.W_rig.topRows<columns>();
  const Eigen::Matrix<double, columns, 3> left = W_rig * elimination.H_inverse;
  g_.segment<columns>(rig) -= left * elimination.g;
  H_.block<columns, columns>(rig, rig) -= left * W_rig.transpose();
  for (std::size_t b = landmark.begin; b < landmark.end; ++b) {
    H_.block<columns, 6>(rig, poseColumn(observations_[b].target)) -= left * W_[b].transpose();
  }
}

void WindowSystem::addImu(std::size_t frame) {
  const WindowState& from = window_.frames[frame - 1].state;
  const WindowState& to = window_.frames[frame].state;
  const NavState& value_i = at_.values.states[frame - 1];
  const NavState& value_j = at_.values.states[frame];
  const WeightedImuRows rows = weightedImuRows(window_.frames[frame].imu, window_.g_w, value_i,
                                               value_j, from.linearizationPoint(value_i),
                                               to.linearizationPoint(value_j), at_.values.rig.imu);
  const Index motion = motionColumn(frame - 1);
  const Index pose = poseColumn(frame - 1);
  const auto J_motion = rows.J.leftCols<18>();
  const auto J_pose = rows.J.rightCols<12>();
  H_.block<18, 18>(motion, motion) += J_motion.transpose() * J_motion;
  H_.block<12, 18>(pose, motion) += J_pose.transpose() * J_motion;
  H_.block<12, 12>(pose, pose) += J_pose.transpose() * J_pose;
  g_.segment<18>(motion) += J_motion.transpose() * rows.r;
  g_.segment<12>(pose) += J_pose.transpose() * rows.r;
  if (refinesRig() && rigVariables().imu) {
    addImuIntrinsics(frame, rows.J, rows.J_intrinsics, rows.r);
  }
}

/// `J_states`: weighted, by motions and poses of the frame before and of the frame.
void WindowSystem::addImuIntrinsics(std::size_t frame,
                                    const Eigen::Matrix<double, 15, 30>& J_states,
                                    const Matrix15d& J, const Vector15d& r) {
  const Index column = rigColumn() + rigVariables().cameraSize();
  H_.block<15, 15>(column, column) += J.transpose() * J;
  H_.block<15, 18>(column, motionColumn(frame - 1)) += J.transpose() * J_states.leftCols<18>();
  H_.block<15, 12>(column, poseColumn(frame - 1)) += J.transpose() * J_states.rightCols<12>();
  g_.segment<15>(column) += J.transpose() * r;
}

void WindowSystem::addStillness(std::size_t frame) {
  if (!window_.frames[frame].stands_still) return;
  const double weight = 1.0 / (window_.rest.velocity * window_.rest.velocity);
  const Index velocity = motionColumn(frame);
  H_.diagonal().segment<3>(velocity).array() += weight;
  g_.segment<3>(velocity) += weight * at_.values.states[frame].v_w;
}

/// The frame stands where the one before it stood.
void WindowSystem::addRest(std::size_t frame) {
  if (!window_.frames[frame].has_rested) return;
  const Pose& T_wi = at_.values.states[frame - 1].T_wb;
  const Pose& T_wj = at_.values.states[frame].T_wb;
  Eigen::Matrix<double, 6, 12> J;
  Eigen::Matrix<double, 6, 6> J_i, J_j;
  zeroMotionResidual(window_.rest, window_.frames[frame - 1].state.poseForJacobians(T_wi),
                     window_.frames[frame].state.poseForJacobians(T_wj), &J_i, &J_j);
  J << J_i, J_j;
  const Eigen::Matrix<double, 6, 1> r =
      zeroMotionResidual(window_.rest, T_wi, T_wj, nullptr, nullptr);
  const Index pose = poseColumn(frame - 1);
  H_.block<12, 12>(pose, pose) += J.transpose() * J;
  g_.segment<12>(pose) += J.transpose() * r;
}

void WindowSystem::addOldTilt() {
  if (!window_.loop) return;
  Eigen::Matrix<double, 2, 3> J;
  const Eigen::Vector2d r = uprightResidual(window_.loop->up_b, 1.0 / window_.old_tilt,
                                            at_.values.old.front().rotation, &J);
  const Index rotation = poseColumn(frameCount()) + 3;
  H_.block<3, 3>(rotation, rotation) += J.transpose() * J;
  g_.segment<3>(rotation) += J.transpose() * r;
}

void WindowSystem::addPrior() {
  if (window_.prior.empty()) return;
  const VectorXd g = window_.prior.A.transpose() * priorResidual(at_);
  Index row = 0;
  for (const Prior::Part& part : window_.prior.parts) {
    g_.segment(column(part), part.size()) += g.segment(row, part.size());
    row += part.size();
  }
}

}  // namespace vins::estimator
