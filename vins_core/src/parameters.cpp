#include "vins_core/parameters.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "text_distance.h"
#include "vins_core/input_error.h"
#include "yaml_document.h"

namespace vins {

struct Parameters::Section {
  std::string file;
  YAML::Node node;
  std::shared_ptr<std::vector<std::string>> remarks;  ///< of all sections of the file
  std::set<std::string> asked = {};
  std::map<std::string, std::shared_ptr<Section>> sections = {};  ///< that were asked for

  bool has(const std::string& key) const {
    const YAML::Node value = find(key);
    return value.IsDefined() && !value.IsNull();
  }

  /// Marks the key as known; whether it has a value.
  bool given(const std::string& key) {
    asked.insert(key);
    return has(key);
  }

  /// Marks the key as known; undefined node where it is absent.
  YAML::Node ask(const std::string& key) {
    asked.insert(key);
    return find(key);
  }

  YAML::Node find(const std::string& key) const {
    return static_cast<const YAML::Node&>(node)[key];
  }

  /// Line of a key's value; of the key itself where it has none: a null has the place of what
  /// follows. 0 where the key is absent.
  int lineOfValue(const std::string& key) const {
    for (const auto& item : node) {
      if (item.first.Scalar() == key)
        return lineOf(item.second.IsNull() ? item.first : item.second);
    }
    return 0;
  }

  std::vector<std::string> unasked() const {
    std::vector<std::string> keys;
    for (const auto& item : node) {
      if (asked.count(item.first.Scalar()) == 0) keys.push_back(item.first.Scalar());
    }
    return keys;
  }
};

namespace {

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string describe(const char* kind, const Range& allowed) {
  std::ostringstream out;
  out << kind;
  if (std::isfinite(allowed.min) && std::isfinite(allowed.max)) {
    out << " from " << allowed.min << " to " << allowed.max;
  } else if (std::isfinite(allowed.min)) {
    out << ", at least " << allowed.min;
  } else if (std::isfinite(allowed.max)) {
    out << ", at most " << allowed.max;
  }
  return out.str();
}

std::string joined(const std::vector<std::string>& words, const std::string& separator = ", ") {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : separator) + word;
  return line;
}

std::optional<double> asNumber(const YAML::Node& node) {
  if (!node.IsScalar()) return std::nullopt;
  const std::string& text = node.Scalar();
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::vector<double>> asNumbers(const YAML::Node& node) {
  if (!node.IsSequence()) return std::nullopt;
  std::vector<double> values;
  for (const YAML::Node& item : node) {
    const std::optional<double> value = asNumber(item);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

/// The entries of an !!opencv-matrix or of a sequence of rows, row by row, if the size fits.
std::optional<std::vector<double>> asMatrix(const YAML::Node& node, int rows, int cols) {
  std::vector<double> entries;
  if (node.IsMap()) {
    const bool size_fits = node["rows"] && node["cols"] && asNumber(node["rows"]) == rows &&
                           asNumber(node["cols"]) == cols;
    if (!size_fits || !node["data"]) return std::nullopt;
    return asNumbers(node["data"]);
  }
  for (const YAML::Node& row : node) {
    const auto values = asNumbers(row);
    if (!values || static_cast<int>(values->size()) != cols) return std::nullopt;
    entries.insert(entries.end(), values->begin(), values->end());
  }
  return entries;
}

}  // namespace

Parameters::Parameters(std::string name, std::shared_ptr<Section> section)
    : name_(std::move(name)), section_(std::move(section)) {}

Parameters Parameters::load(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad()) throw InputError(path + ": cannot be opened for reading");
  return parse(text, path);
}

Parameters Parameters::parse(const std::string& text, const std::string& name) {
  std::vector<std::string> repairs;
  const YAML::Node root = parseYamlMap(text, name, &repairs);
  auto remarks = std::make_shared<std::vector<std::string>>();
  if (!repairs.empty()) {
    remarks->push_back(name + ": mended as OpenCV reads it: " + joined(repairs, "; "));
  }
  return {name, std::make_shared<Section>(Section{name, root, remarks})};
}

bool Parameters::has(const std::string& key) const { return section_->has(key); }

std::vector<std::string> Parameters::keys() const {
  std::vector<std::string> keys;
  for (const auto& item : section_->node) keys.push_back(item.first.Scalar());
  return keys;
}

double Parameters::number(const std::string& key, const Range& allowed) const {
  const YAML::Node node = section_->ask(key);
  const std::optional<double> value = node.IsDefined() ? asNumber(node) : std::nullopt;
  if (!value || *value < allowed.min || *value > allowed.max) {
    fail(key, vins::describe(node), describe("a number", allowed));
  }
  return *value;
}

double Parameters::numberOr(const std::string& key, double fallback, const Range& allowed) const {
  return section_->given(key) ? number(key, allowed) : fallback;
}

int Parameters::integer(const std::string& key, const Range& allowed) const {
  const YAML::Node node = section_->ask(key);
  const std::optional<double> value = node.IsDefined() ? asNumber(node) : std::nullopt;
  const bool is_integer = value && std::floor(*value) == *value && std::abs(*value) < 2147483648.0;
  if (!is_integer || *value < allowed.min || *value > allowed.max) {
    fail(key, vins::describe(node), describe("a whole number", allowed));
  }
  return static_cast<int>(*value);
}

int Parameters::integerOr(const std::string& key, int fallback, const Range& allowed) const {
  return section_->given(key) ? integer(key, allowed) : fallback;
}

bool Parameters::flag(const std::string& key) const {
  const YAML::Node node = section_->ask(key);
  const std::string value =
      node.IsDefined() && node.IsScalar() ? lowered(node.Scalar()) : std::string();
  const std::optional<double> number = node.IsDefined() ? asNumber(node) : std::nullopt;
  if (number == 0.0 || number == 1.0) return *number == 1.0;
  if (value == "true" || value == "yes" || value == "on") return true;
  if (value == "false" || value == "no" || value == "off") return false;
  fail(key, vins::describe(node), "0 or 1");
}

bool Parameters::flagOr(const std::string& key, bool fallback) const {
  return section_->given(key) ? flag(key) : fallback;
}

std::string Parameters::text(const std::string& key,
                             const std::vector<std::string>& allowed) const {
  const YAML::Node node = section_->ask(key);
  const std::string expected = allowed.empty() ? "text" : joined(allowed);
  if (!node.IsDefined() || !node.IsScalar()) fail(key, vins::describe(node), expected);
  if (allowed.empty()) return node.Scalar();
  for (const std::string& word : allowed) {
    if (lowered(word) == lowered(node.Scalar())) return word;
  }
  fail(key, vins::describe(node), expected);
}

std::string Parameters::textOr(const std::string& key, const std::string& fallback,
                               const std::vector<std::string>& allowed) const {
  return section_->given(key) ? text(key, allowed) : fallback;
}

std::vector<double> Parameters::numbers(const std::string& key,
                                        std::initializer_list<std::size_t> counts) const {
  const YAML::Node node = section_->ask(key);
  const auto values = node.IsDefined() ? asNumbers(node) : std::nullopt;
  const bool count_fits =
      values && (counts.size() == 0 ||
                 std::find(counts.begin(), counts.end(), values->size()) != counts.end());
  if (count_fits) return *values;
  std::vector<std::string> allowed;
  for (const std::size_t count : counts) allowed.push_back(std::to_string(count));
  fail(key, vins::describe(node),
       "a sequence of " + (allowed.empty() ? "" : joined(allowed) + " ") + "finite numbers");
}

Eigen::MatrixXd Parameters::matrix(const std::string& key, int rows, int cols) const {
  const YAML::Node node = section_->ask(key);
  const auto entries = node.IsDefined() ? asMatrix(node, rows, cols) : std::nullopt;
  if (!entries || static_cast<int>(entries->size()) != rows * cols) {
    fail(key, vins::describe(node),
         "a matrix of " + std::to_string(rows) + " x " + std::to_string(cols) + " finite numbers");
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(entries->data(), rows, cols);
}

Parameters Parameters::section(const std::string& key) const {
  const YAML::Node node = section_->ask(key);
  if (!node.IsDefined() || !node.IsMap()) {
    fail(key, vins::describe(node), "a section of lines 'key: value'");
  }
  std::shared_ptr<Section>& section = section_->sections[key];
  if (!section)
    section = std::make_shared<Section>(Section{section_->file, node, section_->remarks});
  return {name_ + ": " + key, section};
}

bool Parameters::isSection(const std::string& key) const {
  const YAML::Node node = section_->find(key);
  return node.IsDefined() && node.IsMap();
}

void Parameters::know(const std::vector<std::string>& keys) const {
  section_->asked.insert(keys.begin(), keys.end());
}

std::vector<std::string> Parameters::unknownKeys() const { return section_->unasked(); }

void Parameters::remark(const std::string& key, const std::string& text) const {
  const int line = section_->lineOfValue(key);
  const std::string place = line > 0 ? ":" + std::to_string(line) : "";
  section_->remarks->push_back(section_->file + place + ": " + text);
}

std::vector<std::string> Parameters::remarks() const { return *section_->remarks; }

std::vector<std::string> Parameters::warnings() const {
  const std::vector<std::string> known(section_->asked.begin(), section_->asked.end());
  std::vector<std::string> lines;
  for (const auto& item : section_->node) {
    const std::string key = item.first.Scalar();
    if (section_->asked.count(key) > 0) continue;
    const std::string similar = nearestWord(key, known);
    lines.push_back(section_->file + ":" + std::to_string(lineOf(item.first)) + ": unknown key '" +
                    key + "' is ignored" +
                    (similar.empty() ? "" : "; did you mean '" + similar + "'?"));
  }
  return lines;
}

void Parameters::fail(const std::string& key, const std::string& found,
                      const std::string& allowed) const {
  if (const int line = section_->lineOfValue(key); line > 0) {
    throw InputError(section_->file + ":" + std::to_string(line) + ": key '" + key + "': found " +
                     found + "; allowed: " + allowed);
  }
  const std::string similar = nearestWord(key, section_->unasked());
  throw InputError(name_ + ": key '" + key + "' is missing; allowed: " + allowed +
                   (similar.empty() ? ""
                                    : "; line " + std::to_string(section_->lineOfValue(similar)) +
                                          " has '" + similar + "': is that meant?"));
}

}  // namespace vins
