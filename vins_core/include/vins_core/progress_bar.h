#pragma once

#include <chrono>
#include <cstddef>
#include <iosfwd>
#include <string>

namespace vins {

/// A line that tells how far a command-line program has come: label, bar, share, remaining time,
/// and a word of the program's own. On a terminal the line is redrawn in place; elsewhere a line
/// is printed for every tenth of the work, so that logs stay short.
class ProgressBar {
 public:
  /// `out` must outlive the bar. `total` 0 is drawn as done.
  ProgressBar(std::ostream& out, bool is_terminal, std::string label, std::size_t total);

  /// For standard error, with or without a terminal behind it.
  static ProgressBar onStandardError(std::string label, std::size_t total);

  /// `done` of `total` are done; `note` is shown behind the bar.
  void update(std::size_t done, const std::string& note = "");

  /// Draws the last state and ends the line. Called once.
  void finish(const std::string& note = "");

 private:
  std::string text(std::size_t done, const std::string& note) const;

  std::ostream* out_;
  bool is_terminal_;
  std::string label_;
  std::size_t total_;
  std::size_t tenths_shown_ = 0;
  std::size_t width_shown_ = 0;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_drawn_;
};

}  // namespace vins
