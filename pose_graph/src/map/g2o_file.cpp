#include "pose_graph/map/g2o_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <istream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "pose_graph/graph/six_dof.h"
#include "vins_core/input_error.h"
#include "vins_core/so3.h"
#include "vins_core/text_file.h"

namespace vins::pose_graph {
namespace {

constexpr double kUnitTolerance = 1e-2;
constexpr std::array<int, 3> kPlanarElements = {0, 1, 5};  // of SE(3)'s tangent vectors

/// Values of a line, read one after the other.
class Fields {
 public:
  explicit Fields(const std::string& line) : in_(line) { in_ >> tag_; }

  const std::string& tag() const { return tag_; }
  double number() {
    const std::string text = word("a number");
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (*end != '\0' || !std::isfinite(value)) {
      throw InputError("found '" + text + "' where a finite number is needed");
    }
    return value;
  }
  std::int64_t id() {
    const std::string text = word("an id");
    const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
    if (!digits || text.size() > 18) {
      throw InputError("found '" + text + "' where an id is needed: a whole number from 0 on");
    }
    return std::stoll(text);
  }
  bool atEnd() { return (in_ >> std::ws).eof(); }
  void expectEnd() {
    if (!atEnd()) throw InputError("found '" + word("") + "' after the last value of " + tag_);
  }

 private:
  std::string word(const std::string& needed) {
    std::string text;
    if (!(in_ >> text))
      throw InputError("found the end of the line where " + needed + " is needed");
    return text;
  }

  std::istringstream in_;
  std::string tag_;
};

Pose readSpatialPose(Fields* fields) {
  std::array<double, 7> v{};
  for (double& value : v) value = fields->number();
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (std::abs(q.norm() - 1.0) > kUnitTolerance) {
    throw InputError("found a quaternion of length " + std::to_string(q.norm()) +
                     " where a unit quaternion is needed");
  }
  return {q.normalized(), {v[0], v[1], v[2]}};
}

Pose readPlanarPose(Fields* fields) {
  const double x = fields->number(), y = fields->number(), theta = fields->number();
  return {so3::exp({0.0, 0.0, theta}), {x, y, 0.0}};
}

void readInformation(Fields* fields, bool planar, Eigen::Matrix<double, 6, 6>* information) {
  const int size = planar ? 3 : 6;
  for (int row = 0; row < size; ++row) {
    for (int column = row; column < size; ++column) {
      const int i = planar ? kPlanarElements[std::size_t(row)] : row;
      const int j = planar ? kPlanarElements[std::size_t(column)] : column;
      (*information)(i, j) = (*information)(j, i) = fields->number();
    }
  }
  if (!isPositiveSemidefinite(*information)) {
    throw InputError(
        "found an information matrix with a negative eigenvalue; allowed: positive semidefinite "
        "ones");
  }
}

/// Takes a file in line by line. Poses may come after the edges that name them.
class G2oReader {
 public:
  explicit G2oReader(std::string name) : name_(std::move(name)) {}

  void take(const std::string& line) {
    ++line_;
    const std::size_t start = line.find_first_not_of(" \t\r");
    if (start == std::string::npos || line[start] == '#') return;
    try {
      dispatch(line);
    } catch (const InputError& error) {
      fail(line_, error.what());
    }
  }

  G2oFile finish() {
    if (file_.graph.poses.empty()) throw InputError(name_ + ": no pose in it");
    file_.graph.planar = planar_.value_or(false);
    for (const Mention& mention : mentions_) {
      const auto found = pose_of_id_.find(mention.id);
      if (found == pose_of_id_.end()) {
        fail(mention.line, "found pose " + std::to_string(mention.id) + ", which the file lacks");
      }
      if (mention.fixes) file_.graph.poses[found->second].fixed = true;
    }
    return std::move(file_);
  }

 private:
  struct Mention {
    std::int64_t id = 0;
    int line = 0;
    bool fixes = false;
  };

  [[noreturn]] void fail(int line, const std::string& what) const {
    throw InputError(name_ + ":" + std::to_string(line) + ": " + what);
  }

  void dispatch(const std::string& line) {
    Fields fields(line);
    const std::string& tag = fields.tag();
    const bool planar = tag == "VERTEX_SE2" || tag == "EDGE_SE2";
    if (tag == "FIX") {
      takeFix(&fields);
    } else if (tag == "VERTEX_SE3:QUAT" || tag == "VERTEX_SE2") {
      takePose(planar, &fields);
    } else if (tag == "EDGE_SE3:QUAT" || tag == "EDGE_SE2") {
      takeEdge(planar, &fields);
    } else {
      takeOther(tag, line);
      return;
    }
    fields.expectEnd();
  }

  void choose(bool planar) {
    if (planar_.value_or(planar) != planar) {
      throw InputError("found SE(2) and SE(3) in one file; allowed: one of them");
    }
    planar_ = planar;
  }

  void takePose(bool planar, Fields* fields) {
    choose(planar);
    const std::int64_t id = fields->id();
    if (!pose_of_id_.emplace(id, file_.graph.poses.size()).second) {
      throw InputError("found pose " + std::to_string(id) + " for the second time");
    }
    file_.graph.poses.push_back(
        {id, planar ? readPlanarPose(fields) : readSpatialPose(fields), false});
  }

  void takeEdge(bool planar, Fields* fields) {
    choose(planar);
    RelativePoseEdge edge;
    edge.from = fields->id();
    edge.to = fields->id();
    if (edge.from == edge.to) throw InputError("found an edge from a pose to itself");
    edge.T_ij = planar ? readPlanarPose(fields) : readSpatialPose(fields);
    readInformation(fields, planar, &edge.information);
    mentions_.push_back({edge.from, line_, false});
    mentions_.push_back({edge.to, line_, false});
    file_.graph.edges.push_back(edge);
  }

  void takeFix(Fields* fields) {
    do {
      mentions_.push_back({fields->id(), line_, true});
    } while (!fields->atEnd());
  }

  void takeOther(const std::string& tag, const std::string& line) {
    file_.other_lines.push_back(line.substr(0, line.find_last_not_of("\r") + 1));
    if (!other_tags_.insert(tag).second) return;
    file_.warnings.push_back(name_ + ":" + std::to_string(line_) + ": unknown tag '" + tag +
                             "'; its lines are kept as they are");
  }

  std::string name_;
  G2oFile file_;
  int line_ = 0;
  std::optional<bool> planar_;
  std::map<std::int64_t, std::size_t> pose_of_id_;
  std::vector<Mention> mentions_;
  std::set<std::string> other_tags_;
};

void writePose(std::ostream& out, const Pose& T, bool planar) {
  const Eigen::Vector3d& p = T.position;
  const Eigen::Quaterniond& q = T.rotation;
  out << " " << p.x() << " " << p.y();
  if (planar) {
    out << " " << so3::log(q).z();
  } else {
    out << " " << p.z() << " " << q.x() << " " << q.y() << " " << q.z() << " " << q.w();
  }
}

void writeInformation(std::ostream& out, const Eigen::Matrix<double, 6, 6>& A, bool planar) {
  const int size = planar ? 3 : 6;
  for (int row = 0; row < size; ++row) {
    for (int column = row; column < size; ++column) {
      const int i = planar ? kPlanarElements[std::size_t(row)] : row;
      const int j = planar ? kPlanarElements[std::size_t(column)] : column;
      out << " " << A(i, j);
    }
  }
}

}  // namespace

G2oFile readG2o(std::istream& in, const std::string& name) {
  G2oReader reader(name);
  for (std::string line; std::getline(in, line);) reader.take(line);
  return reader.finish();
}

G2oFile readG2oFile(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw InputError(path + ": cannot be opened for reading");
  return readG2o(in, path);
}

std::string toG2o(const G2oFile& file) {
  std::ostringstream out;
  out << std::setprecision(std::numeric_limits<double>::max_digits10);
  const bool planar = file.graph.planar;
  const std::string suffix = planar ? "SE2 " : "SE3:QUAT ";
  for (const GraphPose& pose : file.graph.poses) {
    out << "VERTEX_" << suffix << pose.id;
    writePose(out, pose.T_wi, planar);
    out << "\n";
    if (pose.fixed) out << "FIX " << pose.id << "\n";
  }
  for (const RelativePoseEdge& edge : file.graph.edges) {
    out << "EDGE_" << suffix << edge.from << " " << edge.to;
    writePose(out, edge.T_ij, planar);
    writeInformation(out, edge.information, planar);
    out << "\n";
  }
  for (const std::string& line : file.other_lines) out << line << "\n";
  return out.str();
}

void writeG2oFile(const std::string& path, const G2oFile& file) {
  writeTextFile(path, toG2o(file));
}

}  // namespace vins::pose_graph
