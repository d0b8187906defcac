#pragma once

#include <string>
#include <vector>

namespace vins {

/// Keys at the top of a rig's configuration file that some stage reads, or that are known to have
/// no effect (VINS-Mono's output_path, say). A node reads the keys of its own stage only; by these
/// it knows the others' keys from slips of the pen. docs/parameters.md tells what they mean; a test
/// holds it against this list and against the readers.
std::vector<std::string> rigKeys();

}  // namespace vins
