#include "yaml_document.h"

#include <map>

#include "opencv_yaml.h"
#include "vins_core/input_error.h"

namespace vins {
namespace {

std::string place(const std::string& name, const YAML::Mark& mark) {
  if (mark.is_null()) return name;
  return name + ":" + std::to_string(mark.line + 1);
}

/// Lookup in a YAML::Node finds the first of several equal keys, so nothing is to be changed.
void reportRepeatedKeys(const YAML::Node& node, std::vector<std::string>* repairs) {
  if (node.IsSequence()) {
    for (const YAML::Node& item : node) reportRepeatedKeys(item, repairs);
  }
  if (!node.IsMap()) return;
  std::map<std::string, int> lines;
  for (const auto& item : node) {
    const std::string key = item.first.IsScalar() ? item.first.Scalar() : "";
    const auto [first, is_new] = lines.emplace(key, lineOf(item.first));
    if (!is_new) {
      repairs->push_back("line " + std::to_string(lineOf(item.first)) + ": '" + key +
                         "' is given again; the value of line " + std::to_string(first->second) +
                         " counts");
    }
    reportRepeatedKeys(item.second, repairs);
  }
}

}  // namespace

YAML::Node parseYamlMap(const std::string& text, const std::string& name,
                        std::vector<std::string>* repairs) {
  YAML::Node root;
  try {
    root = YAML::Load(standardYaml(text, repairs));
  } catch (const YAML::Exception& error) {
    throw InputError(place(name, error.mark) + ": not valid YAML at column " +
                     std::to_string(error.mark.column + 1) + ": " + error.msg);
  }
  if (!root.IsMap()) {
    throw InputError(name + ": found " + describe(root) +
                     "; allowed: lines of the form 'key: value'");
  }
  reportRepeatedKeys(root, repairs);
  return root;
}

int lineOf(const YAML::Node& node) { return node.Mark().line + 1; }

std::string describe(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) return "nothing";
  if (node.IsSequence()) return "a sequence of " + std::to_string(node.size());
  if (node.IsMap()) return "a section";
  return "'" + node.Scalar() + "'";
}

}  // namespace vins
