#pragma once

#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace vins {

/// Root of the YAML document `text`, which must be a map. What OpenCV's reader accepts and YAML
/// does not is repaired, see standardYaml(); of a key that is given twice the first value counts,
/// as with OpenCV. `repairs` gets a text for each. Throws InputError with `name`, line and column.
YAML::Node parseYamlMap(const std::string& text, const std::string& name,
                        std::vector<std::string>* repairs);

/// Line of a node, counted from 1.
int lineOf(const YAML::Node& node);

/// How a node reads in a message: its text, or what kind of thing it is.
std::string describe(const YAML::Node& node);

}  // namespace vins
