// Draws the pattern by which BRIEF compares pixels, and writes it as a YAML file.

#include <iostream>
#include <string>

#include <boost/program_options.hpp>

#include "pose_graph/place/brief.h"
#include "vins_core/text_file.h"

namespace po = boost::program_options;

int main(int argc, char** argv) {
  try {
    po::options_description options("Options");
    options.add_options()("help", "print this text")  //
        ("output,o", po::value<std::string>()->required(), "YAML file to write")(
            "seed", po::value<std::uint64_t>()->default_value(1), "same seed, same pattern")(
            "patch", po::value<int>()->default_value(49), "side of the compared square [px]");
    po::variables_map values;
    po::store(po::command_line_parser(argc, argv).options(options).run(), values);
    if (values.count("help") != 0) {
      std::cout << "Draws the 256 pairs of pixels that BRIEF compares.\n"
                   "Example: make_brief_pattern -o brief_pattern.yml\n\n"
                << options;
      return 0;
    }
    po::notify(values);
    const auto pattern =
        vins::BriefPattern::generate(values["seed"].as<std::uint64_t>(), values["patch"].as<int>());
    vins::writeTextFile(values["output"].as<std::string>(), pattern.toYaml());
    return 0;
  } catch (const po::error& error) {
    std::cerr << "make_brief_pattern: " << error.what() << "; see --help\n";
  } catch (const std::exception& error) {
    std::cerr << "make_brief_pattern: " << error.what() << "\n";
  }
  return 1;
}
