// SPDX-License-Identifier: MIT
#include "cli/progress_display.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace h2mc {
namespace {

constexpr double kSecondsBetweenBars = 0.1;
constexpr double kSecondsBetweenLines = 5;

int terminalColumns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string withPrefix(double number) {
  if (!std::isfinite(number)) return "?";
  // Limits that do not round up to "1e+03".
  if (number < 999.5) return fmt::format("{:.3g}", number);
  if (number < 999.5e3) return fmt::format("{:.3g} k", number / 1e3);
  if (number < 999.5e6) return fmt::format("{:.3g} M", number / 1e6);
  return fmt::format("{:.3g} G", number / 1e9);
}

std::string duration(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0 || seconds > 1e7) return "?";
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const long whole = std::lround(seconds);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

ProgressDisplay::Style ProgressDisplay::styleOfStderr() {
  const char* terminal = std::getenv("TERM");
  const bool dumb = !terminal || std::string_view(terminal) == "dumb";
  return isatty(STDERR_FILENO) && !dumb ? Style::kBar : Style::kLines;
}

ProgressDisplay::ProgressDisplay(Style style, double secondsGiven)
    : style_(style), secondsGiven_(secondsGiven) {
  // The first line tells something only after a while.
  if (style_ == Style::kLines) lastShown_ = 0;
}

ProgressDisplay::~ProgressDisplay() {
  if (barShown_) std::fputs("\r\033[K", stderr);
}

void ProgressDisplay::update(const RenderProgress& progress) {
  if (style_ == Style::kNone) return;
  const std::lock_guard lock(mutex_);
  const double interval = style_ == Style::kBar ? kSecondsBetweenBars : kSecondsBetweenLines;
  if (progress.elapsedSeconds - lastShown_ < interval) return;
  lastShown_ = progress.elapsedSeconds;
  if (style_ == Style::kBar) {
    std::fputs(("\r" + bar(progress) + "\033[K").c_str(), stderr);
    std::fflush(stderr);
    barShown_ = true;
  } else {
    std::fputs((text(progress) + "\n").c_str(), stderr);
  }
}

std::string ProgressDisplay::text(const RenderProgress& progress) const {
  const double fraction = std::clamp(progress.fraction, 0.0, 1.0);
  std::string left = "?";
  if (secondsGiven_ > 0)
    left = duration(std::max(0.0, secondsGiven_ - progress.elapsedSeconds));
  else if (fraction > 0)
    left = duration(progress.elapsedSeconds * (1 - fraction) / fraction);
  std::string rate;
  if (progress.rate > 0)
    rate = fmt::format("  {} {}/s", withPrefix(progress.rate), progress.rateUnit);
  return fmt::format("{:3.0f} %{}  {} left", std::floor(100 * fraction), rate, left);
}

std::string ProgressDisplay::bar(const RenderProgress& progress) const {
  std::string line = text(progress);
  const int columns = terminalColumns() - 1;  // the last one would wrap on some terminals
  const int room = std::min(40, columns - static_cast<int>(line.size()) - 3);
  if (room >= 5) {
    const int filled = static_cast<int>(std::clamp(progress.fraction, 0.0, 1.0) * room);
    line = "[" + std::string(filled, '#') + std::string(room - filled, '.') + "] " + line;
  }
  return line.substr(0, std::max(columns, 1));
}

}  // namespace h2mc
