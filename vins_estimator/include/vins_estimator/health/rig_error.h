#pragma once

#include <deque>
#include <vector>

#include <Eigen/Core>

namespace vins::estimator {

/// What can be wrong about a rig.
enum class RigPart { kTranslation, kRotation, kTimeOffset, kReadout, kFocalLength };

/// Errors of a rig, stacked: true value minus the value in use. Translation of T_bc [m, body
/// frame], rotation of T_bc [rad, on the right: about the camera's axes], td [s], read-out of all
/// rows [s], focal length [share of it].
using RigErrorVector = Eigen::Matrix<double, 9, 1>;
using RigErrorInformation = Eigen::Matrix<double, 9, 9>;

/// Where a part stands among them.
struct RigErrorRows {
  int begin = 0;
  int count = 0;
};
RigErrorRows rowsOf(RigPart part);

/// What the residuals of one window tell of the rig's error e. With all states and landmarks moved
/// along to their best, half the sum of squared weighted residuals is, to second order,
/// constant + gradient^T e + e^T information e / 2.
struct RigScore {
  RigErrorInformation information = RigErrorInformation::Zero();
  RigErrorVector gradient = RigErrorVector::Zero();
  double cost = 0.0;  ///< half the sum of squares, as the window stands
};

/// How well an error of one part explains the residuals of several windows.
struct RigExplanation {
  RigPart part = RigPart::kTranslation;
  Eigen::VectorXd error;   ///< of least squares, as stacked in RigErrorVector
  double size = 0.0;       ///< its length [m], [rad], [s] or a share
  double deviation = 0.0;  ///< of the size, the scatter between the windows included
  double gain = 0.0;       ///< by how much it lessens the sum of squares [deviations squared]
  double share = 0.0;      ///< by what share
  /// How much the windows disagree about it: chi squared over its degrees of freedom, at least 1
  /// (R. T. Birge, "The calculation of errors by the method of least squares", Phys. Rev. 1932);
  /// more where these are few, for then it may be so small by chance.
  double scatter = 1.0;
};

/// Score test (C. R. Rao, 1948) of one part's error against a right rig. Parts that are `estimated`
/// adapt along with the states: what they can explain is none of this part's gain. Windows must not
/// overlap in time, for their errors are taken as independent.
RigExplanation explainBy(RigPart part, const std::vector<RigPart>& estimated,
                         const std::deque<RigScore>& scores);

}  // namespace vins::estimator
