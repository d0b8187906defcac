#pragma once

#include <iosfwd>
#include <string>

#include "vins_core/trajectory.h"

namespace vins {

/// Reads a trajectory: TUM's text form (stamp [s], tx ty tz [m], qx qy qz qw; '#' starts a comment)
/// or EuRoC's csv (stamp [ns], px py pz, qw qx qy qz, more columns). The form is told by the
/// commas. Stamps are read digit by digit, so nanoseconds survive. Throws InputError with `name`
/// and the line where a number is missing or not finite, a quaternion is not of unit length
/// (to 1e-2; then it is normalized) or stamps do not rise.
Trajectory readTrajectory(std::istream& in, const std::string& name);

/// The same from the file at `path`.
Trajectory readTrajectoryFile(const std::string& path);

/// One line of TUM's form, nanoseconds kept: nine decimals of stamp, position and quaternion.
std::string toTumLine(const StampedPose& pose);

/// Whole nanoseconds of a decimal number of seconds ("1403715273.26214"); digits beyond nine
/// decimals are dropped. Throws InputError when `text` is not such a number.
Stamp parseSeconds(const std::string& text);

}  // namespace vins
