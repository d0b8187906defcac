#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>

#include "simulation/odometry_figures.h"

namespace vins::simulation {
namespace {

/// A figure's name in JSON, its column in the table, and the figure.
struct Column {
  const char* name;
  const char* head;
  double unit;  ///< of the table, in that of the figure
  int decimals;
  std::function<double(OdometryFigures*)> get;
  std::function<void(OdometryFigures*, double)> set;
};

Column column(const char* name, const char* head, double unit, int decimals,
              double OdometryFigures::*member) {
  return {name,
          head,
          unit,
          decimals,
          [member](OdometryFigures* f) { return f->*member; },
          [member](OdometryFigures* f, double value) { f->*member = value; }};
}

Column column(const char* name, const char* head, double Consistency::*member) {
  return {name,
          head,
          1.0,
          2,
          [member](OdometryFigures* f) { return f->nees.*member; },
          [member](OdometryFigures* f, double value) { f->nees.*member = value; }};
}

std::vector<Column> allColumns() {
  using F = OdometryFigures;
  const double degree = M_PI / 180.0;
  return {
      column("completeness", "complete%", 0.01, 1, &F::completeness),
      column("resets", "resets", 1.0, 0, &F::resets),
      column("time_to_initialise_s", "init s", 1.0, 2, &F::time_to_initialise),
      {"early_scale_error", "scale2s%", 0.01, 2,
       [](F* f) { return f->early_scale_error.value_or(std::nan("")); },
       [](F* f, double value) { f->early_scale_error = value; }},
      column("scale_error", "scale%", 0.01, 3, &F::scale_error),
      column("distance_m", "flown m", 1.0, 1, &F::distance),
      column("ate_m", "ATE m", 1.0, 4, &F::ate),
      {"ate_share", "ATE%", 0.01, 3, [](F* f) { return f->ateShare(); }, [](F*, double) {}},
      column("rotation_error_rad", "rot deg", degree, 3, &F::rotation_error),
      column("drift_m", "drift m", 1.0, 3, &F::drift),
      column("nees_position", "N pos", &Consistency::position),
      column("nees_rotation", "N rot", &Consistency::rotation),
      column("nees_pose", "N pose", &Consistency::pose),
      column("nees_velocity", "N vel", &Consistency::velocity),
      column("nees_accelerometer_bias", "N ba", &Consistency::accelerometer_bias),
      column("nees_gyroscope_bias", "N bg", &Consistency::gyroscope_bias),
      column("td_error_s", "td ms", 1e-3, 2, &F::td_error),
      column("extrinsic_rotation_error_rad", "R_bc deg", degree, 3, &F::extrinsic_rotation_error),
      column("extrinsic_translation_error_m", "p_bc mm", 1e-3, 1, &F::extrinsic_translation_error),
      column("nees_rig", "N rig", 1.0, 2, &F::nees_rig),
      column("uncovered", "no cov%", 0.01, 1, &F::uncovered),
      column("mean_ms", "ms", 1.0, 2, &F::mean_ms),
      column("p95_ms", "p95 ms", 1.0, 2, &F::p95_ms)};
}

bool isOfAllRuns(const Column& c) {
  const std::string name = c.name;
  return name == "completeness" || name == "resets" || name == "mean_ms" || name == "p95_ms";
}

/// Signed errors are averaged by their size: they would cancel.
bool isSigned(const Column& c) {
  return std::string(c.name).find("scale_error") != std::string::npos;
}

double meanOf(const Column& c, std::vector<OdometryFigures> figures) {
  double sum = 0.0;
  int count = 0;
  for (OdometryFigures& f : figures) {
    const double value = c.get(&f);
    if ((!f.initialised && !isOfAllRuns(c)) || std::isnan(value)) continue;
    sum += isSigned(c) ? std::abs(value) : value;
    ++count;
  }
  return count > 0 ? sum / count : std::nan("");
}

void printRow(std::ostream& out, const std::string& label, OdometryFigures figures) {
  out << std::setw(5) << label;
  for (const Column& c : allColumns()) {
    const double value = c.get(&figures);
    out << " " << std::setw(9);
    if (std::isnan(value) || (!figures.initialised && !isOfAllRuns(c))) {
      out << "-";
    } else {
      out << std::fixed << std::setprecision(c.decimals) << value / c.unit;
    }
  }
  out << "\n";
}

std::string jsonOf(OdometryFigures figures) {
  std::ostringstream out;
  out << std::setprecision(9) << std::boolalpha << "{\"seed\": " << figures.seed
      << ", \"initialised\": " << figures.initialised;
  for (const Column& c : allColumns()) {
    const double value = c.get(&figures);
    out << ", \"" << c.name << "\": ";
    if (std::isfinite(value)) {
      out << value;
    } else {
      out << "null";
    }
  }
  out << "}";
  return out.str();
}

}  // namespace

OdometryAverages average(const std::vector<OdometryFigures>& figures) {
  OdometryAverages averages;
  averages.runs = figures.size();
  for (const OdometryFigures& f : figures) {
    if (!f.initialised) continue;
    ++averages.initialised;
    averages.worst_ate = std::max(averages.worst_ate, f.ate);
    averages.worst_scale_error = std::max(averages.worst_scale_error, std::abs(f.scale_error));
  }
  averages.mean.initialised = averages.initialised > 0;
  for (const Column& c : allColumns()) c.set(&averages.mean, meanOf(c, figures));
  return averages;
}

void printTable(std::ostream& out, const std::vector<OdometryFigures>& figures) {
  out << std::setw(5) << "seed";
  for (const Column& c : allColumns()) out << " " << std::setw(9) << c.head;
  out << "\n";
  for (const OdometryFigures& f : figures) printRow(out, std::to_string(f.seed), f);
  const OdometryAverages averages = average(figures);
  printRow(out, "mean", averages.mean);
  out << averages.initialised << " of " << averages.runs << " runs initialised; worst ATE "
      << std::setprecision(4) << averages.worst_ate << " m, worst scale error "
      << std::setprecision(2) << 100.0 * averages.worst_scale_error
      << " %; N: NEES per degree of freedom, 1 is right\n";
}

std::string toJson(const std::vector<OdometryFigures>& figures) {
  std::string text = "{\"runs\": [";
  for (std::size_t i = 0; i < figures.size(); ++i) {
    text += (i == 0 ? "\n  " : ",\n  ") + jsonOf(figures[i]);
  }
  return text + "],\n\"mean\": " + jsonOf(average(figures).mean) + "}\n";
}

}  // namespace vins::simulation
