#include "yaml_document.h"

#include <map>

#include "vins_core/input_error.h"

namespace vins {
namespace {

/// OpenCV writes "%YAML:1.0" where YAML wants "%YAML 1.0"; as a comment it says the same, and the
/// lines keep their numbers.
std::string withoutOpencvDirective(const std::string& text) {
  const std::size_t start = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (start == std::string::npos || text.compare(start, 6, "%YAML:") != 0) return text;
  std::string plain = text;
  plain[start] = '#';
  return plain;
}

std::string place(const std::string& name, const YAML::Mark& mark) {
  if (mark.is_null()) return name;
  return name + ":" + std::to_string(mark.line + 1);
}

void refuseRepeatedKeys(const YAML::Node& node, const std::string& name) {
  if (node.IsSequence()) {
    for (const YAML::Node& item : node) refuseRepeatedKeys(item, name);
  }
  if (!node.IsMap()) return;
  std::map<std::string, int> lines;
  for (const auto& item : node) {
    const std::string key = item.first.IsScalar() ? item.first.Scalar() : "";
    const auto [first, is_new] = lines.emplace(key, lineOf(item.first));
    if (!is_new) {
      throw InputError(place(name, item.first.Mark()) + ": key '" + key +
                       "' stands here and in line " + std::to_string(first->second) +
                       "; allowed: once");
    }
    refuseRepeatedKeys(item.second, name);
  }
}

}  // namespace

YAML::Node parseYamlMap(const std::string& text, const std::string& name) {
  YAML::Node root;
  try {
    root = YAML::Load(withoutOpencvDirective(text));
  } catch (const YAML::Exception& error) {
    throw InputError(place(name, error.mark) + ": not valid YAML at column " +
                     std::to_string(error.mark.column + 1) + ": " + error.msg);
  }
  if (!root.IsMap()) {
    throw InputError(name + ": found " + describe(root) +
                     "; allowed: lines of the form 'key: value'");
  }
  refuseRepeatedKeys(root, name);
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
