#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

namespace vins {

/// Root of the YAML document `text`, which must be a map without repeated keys at any depth.
/// OpenCV's "%YAML:1.0" line is accepted. Throws InputError with `name`, line and column.
YAML::Node parseYamlMap(const std::string& text, const std::string& name);

/// Line of a node, counted from 1.
int lineOf(const YAML::Node& node);

/// How a node reads in a message: its text, or what kind of thing it is.
std::string describe(const YAML::Node& node);

}  // namespace vins
