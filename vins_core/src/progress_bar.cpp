#include "vins_core/progress_bar.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <utility>

#include <unistd.h>

namespace vins {
namespace {

constexpr std::size_t kCells = 24;
constexpr std::chrono::milliseconds kRedrawInterval(100);

}  // namespace

ProgressBar::ProgressBar(std::ostream& out, bool is_terminal, std::string label, std::size_t total)
    : out_(&out),
      is_terminal_(is_terminal),
      label_(std::move(label)),
      total_(total),
      start_(std::chrono::steady_clock::now()),
      last_drawn_(start_ - kRedrawInterval) {}

ProgressBar ProgressBar::onStandardError(std::string label, std::size_t total) {
  return {std::cerr, isatty(STDERR_FILENO) != 0, std::move(label), total};
}

void ProgressBar::update(std::size_t done, const std::string& note) {
  if (!is_terminal_) {
    const std::size_t tenths = total_ == 0 ? 10 : std::min<std::size_t>(10, 10 * done / total_);
    if (tenths > tenths_shown_) *out_ << text(done, note) << std::endl;
    tenths_shown_ = std::max(tenths_shown_, tenths);
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - last_drawn_ < kRedrawInterval) return;
  last_drawn_ = now;
  std::string line = text(done, note);
  const std::size_t width = line.size();
  if (width < width_shown_) line.append(width_shown_ - width, ' ');
  width_shown_ = width;
  *out_ << '\r' << line << std::flush;
}

void ProgressBar::finish(const std::string& note) {
  if (is_terminal_) {
    std::string line = text(total_, note);
    if (line.size() < width_shown_) line.append(width_shown_ - line.size(), ' ');
    *out_ << '\r' << line << std::endl;
  } else if (tenths_shown_ < 10 || !note.empty()) {
    *out_ << text(total_, note) << std::endl;
  }
}

std::string ProgressBar::text(std::size_t done, const std::string& note) const {
  const double share =
      total_ == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  const auto filled = static_cast<std::size_t>(std::lround(share * kCells));
  std::ostringstream line;
  line << label_ << " [" << std::string(filled, '#') << std::string(kCells - filled, '.') << "] "
       << std::setw(3) << std::lround(100.0 * share) << " %";
  if (share > 0.0 && share < 1.0) {
    line << "  " << std::lround(elapsed.count() * (1.0 - share) / share) << " s left";
  }
  if (!note.empty()) line << "  " << note;
  return line.str();
}

}  // namespace vins
