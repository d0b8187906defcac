#include "vins_core/trajectory_file.h"

#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <istream>
#include <vector>

#include "vins_core/input_error.h"

namespace vins {
namespace {

constexpr double kUnitTolerance = 1e-2;

std::vector<std::string> splitFields(const std::string& line, bool by_comma) {
  std::vector<std::string> fields;
  std::string field;
  for (const char c : line) {
    const bool separates = by_comma ? c == ',' : std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!separates && !std::isspace(static_cast<unsigned char>(c))) field += c;
    if (separates && (by_comma || !field.empty())) {
      fields.push_back(field);
      field.clear();
    }
  }
  if (!field.empty()) fields.push_back(field);
  return fields;
}

double parseNumber(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) {
    throw InputError("found '" + text + "' where a finite number is needed");
  }
  return value;
}

/// Stamps from 9e18 ns on, in the year 2255, are refused: their numbers end soon after.
Stamp parseInteger(const std::string& text) {
  const bool fits = text.size() < 19 || (text.size() == 19 && text[0] != '9');
  if (text.empty() || !fits || text.find_first_not_of("0123456789") != text.npos) {
    throw InputError("found '" + text + "' where a stamp is needed");
  }
  return std::stoll(text);
}

Eigen::Quaterniond parseRotation(double w, double x, double y, double z) {
  const Eigen::Quaterniond q(w, x, y, z);
  if (std::abs(q.norm() - 1.0) > kUnitTolerance) {
    throw InputError("found a quaternion of length " + std::to_string(q.norm()) +
                     " where a unit quaternion is needed");
  }
  return q.normalized();
}

StampedPose parseLine(const std::string& line) {
  const bool is_csv = line.find(',') != std::string::npos;
  const std::vector<std::string> fields = splitFields(line, is_csv);
  if (fields.size() < 8) {
    throw InputError("found " + std::to_string(fields.size()) +
                     " values where a stamp, a position and a quaternion (8) are needed");
  }
  std::array<double, 7> v{};
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = parseNumber(fields[i + 1]);
  const Eigen::Vector3d position(v[0], v[1], v[2]);
  if (is_csv) return {parseInteger(fields[0]), {parseRotation(v[3], v[4], v[5], v[6]), position}};
  return {parseSeconds(fields[0]), {parseRotation(v[6], v[3], v[4], v[5]), position}};
}

}  // namespace

Stamp parseSeconds(const std::string& text) {
  const std::size_t dot = text.find('.');
  const std::string whole = text.substr(0, dot);
  std::string decimals = dot == std::string::npos ? "" : text.substr(dot + 1);
  const bool digits_only = (whole + decimals).find_first_not_of("0123456789") == std::string::npos;
  const bool fits = whole.size() < 10 || (whole.size() == 10 && whole[0] != '9');
  if (!digits_only || (whole + decimals).empty() || !fits) {
    throw InputError("found '" + text + "' where a stamp in seconds is needed");
  }
  decimals.resize(9, '0');
  return std::stoll((whole.empty() ? "0" : whole) + decimals);
}

Trajectory readTrajectory(std::istream& in, const std::string& name) {
  Trajectory trajectory;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::size_t start = line.find_first_not_of(" \t\r");
    if (start == std::string::npos || line[start] == '#') continue;
    try {
      trajectory.append(parseLine(line.substr(start)));
    } catch (const InputError& error) {
      throw InputError(name + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  if (trajectory.empty()) throw InputError(name + ": no pose in it");
  return trajectory;
}

Trajectory readTrajectoryFile(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw InputError(path + ": cannot be opened for reading");
  return readTrajectory(in, path);
}

std::string toTumLine(const StampedPose& pose) {
  const Eigen::Vector3d& p = pose.T_wb.position;
  const Eigen::Quaterniond& q = pose.T_wb.rotation;
  std::array<char, 256> line{};
  std::snprintf(line.data(), line.size(), "%lld.%09lld %.9f %.9f %.9f %.9f %.9f %.9f %.9f",
                static_cast<long long>(pose.stamp / 1000000000),
                static_cast<long long>(pose.stamp % 1000000000), p.x(), p.y(), p.z(), q.x(), q.y(),
                q.z(), q.w());
  return line.data();
}

}  // namespace vins
