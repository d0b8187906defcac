#pragma once

#include <exception>
#include <functional>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>

namespace vins {

/// Exit codes of command-line tools.
enum class ToolExit {
  kDone = 0,
  kBadInput = 1,      ///< what was given cannot be used; a line on standard error says why
  kFellShort = 2,     ///< it worked, but did not reach what it is for; the tool's help says what
  kInterrupted = 130  ///< by Ctrl-C, as a shell has it
};

/// What a tool tells and takes.
struct ToolDescription {
  std::string name;   ///< begins each message
  std::string about;  ///< --help: what it does, and how it is called; whole lines
  boost::program_options::options_description options;  ///< without --help, which every tool has
  /// Options that may be given without their names, in order, and how many of each; -1: all that
  /// follow.
  std::vector<std::pair<std::string, int>> positional = {};
  std::string notes = "";  ///< --help: what comes below the options; whole lines
};

/// The main() of a command-line tool: reads the options and runs `body` with them. Returns the exit
/// code: the body's; kBadInput where options are unknown, missing or malformed, or where something
/// was thrown, which is told on standard error in one line. --help prints the description on
/// standard output and runs nothing. Header only: who includes it links Boost::program_options.
inline int runTool(
    int argc, char** argv, const ToolDescription& tool,
    const std::function<ToolExit(const boost::program_options::variables_map&)>& body) {
  namespace po = boost::program_options;
  try {
    po::options_description options("Options");
    options.add_options()("help", "print this text");
    for (const auto& option : tool.options.options()) options.add(option);
    po::positional_options_description positional;
    for (const auto& [name, count] : tool.positional) positional.add(name.c_str(), count);
    po::command_line_parser parser(argc, argv);
    parser.options(options);
    if (!tool.positional.empty()) parser.positional(positional);
    po::variables_map values;
    po::store(parser.run(), values);
    if (values.count("help") > 0) {
      std::cout << tool.about << "\n" << options;
      if (!tool.notes.empty()) std::cout << "\n" << tool.notes;
      return static_cast<int>(ToolExit::kDone);
    }
    po::notify(values);
    return static_cast<int>(body(values));
  } catch (const po::error& error) {
    std::cerr << tool.name << ": " << error.what() << "; see --help\n";
  } catch (const std::exception& error) {
    std::cerr << tool.name << ": " << error.what() << "\n";
  }
  return static_cast<int>(ToolExit::kBadInput);
}

}  // namespace vins
