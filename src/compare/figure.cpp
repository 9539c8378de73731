// SPDX-License-Identifier: MIT
#include "compare/figure.h"

#include <algorithm>

namespace h2mc {
namespace {

constexpr double kWidthOfLetter = 0.53;  // of its size, in Helvetica

}  // namespace

std::string fitted(const std::string& text, double size, double width) {
  const auto room = static_cast<std::size_t>(std::max(4.0, width / (kWidthOfLetter * size)));
  return text.size() <= room ? text : text.substr(0, room - 2) + "..";
}

double widthOf(const std::string& text, double size) {
  return kWidthOfLetter * size * static_cast<double>(text.size());
}

}  // namespace h2mc
