// SPDX-License-Identifier: MIT
#include "render/path/path_text.h"

#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <sstream>
#include <vector>

#include "render/core/index.h"

namespace h2mc {
namespace {

bool parseNumbers(const std::string& text, std::vector<float>& numbers) {
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');) {
    char* end = nullptr;
    const double value = std::strtod(item.c_str(), &end);
    if (item.empty() || *end != '\0' || !(value >= 0)) return false;
    numbers.push_back(static_cast<float>(value));
    if (!(numbers.back() < 1)) return false;
  }
  return true;
}

}  // namespace

std::string pathText(const Technique& technique, const PrimarySample& sample) {
  std::string text = fmt::format("s={} t={} u=", technique.s, technique.t);
  for (int i = 0; i < technique.dimension(); ++i)
    text += fmt::format("{}{:a}", i ? "," : "", sample.u[at(i)]);
  text += " choice=";
  for (int i = 0; i < technique.choices(); ++i)
    text += fmt::format("{}{:a}", i ? "," : "", sample.choice[at(i)]);
  if (sample.aperture != PrimarySample().aperture)
    text += fmt::format(" aperture={:a},{:a}", sample.aperture[0], sample.aperture[1]);
  if (sample.time > 0) text += fmt::format(" time={:a}", sample.time);
  return text;
}

std::string parsePathText(const std::string& text, Technique& technique, PrimarySample& sample) {
  std::map<std::string, std::string> parts;
  std::istringstream stream(text);
  for (std::string item; stream >> item;) {
    const std::size_t equals = item.find('=');
    const std::string name = item.substr(0, equals);
    if (equals == std::string::npos || (name != "s" && name != "t" && name != "u" &&
                                        name != "choice" && name != "aperture" && name != "time"))
      return "expected \"s=.. t=.. u=..,.. choice=..,.. [aperture=..,..] [time=..]\", got \"" +
             item + "\"";
    parts[name] = item.substr(equals + 1);
  }
  for (const char* name : {"s", "t", "u"})
    if (!parts.contains(name)) return fmt::format("\"{}=\" is missing", name);
  const auto whole = [&](const char* name, int& value) {
    char* end = nullptr;
    const std::string& digits = parts[name];
    const long number = std::strtol(digits.c_str(), &end, 10);
    value = static_cast<int>(number);
    return !digits.empty() && *end == '\0' && number >= 0 && number <= kMaxPathLength + 1;
  };
  if (!whole("s", technique.s) || !whole("t", technique.t) || technique.t < 1 ||
      technique.length() < 1 || technique.length() > kMaxPathLength || technique == Technique{1, 1})
    return fmt::format("there is no technique s={} t={} of 1 to {} edges", parts["s"], parts["t"],
                       kMaxPathLength);
  std::vector<float> u, choice, aperture, time;
  if (!parseNumbers(parts["u"], u)) return "u: expected numbers in [0, 1) with commas between";
  if (!parseNumbers(parts["choice"], choice))
    return "choice: expected numbers in [0, 1) with commas between";
  if (static_cast<int>(u.size()) != technique.dimension())
    return fmt::format("s={} t={} has {} coordinates u, got {}", technique.s, technique.t,
                       technique.dimension(), u.size());
  if (static_cast<int>(choice.size()) != technique.choices())
    return fmt::format("s={} t={} has {} choices, got {}", technique.s, technique.t,
                       technique.choices(), choice.size());
  if (!parseNumbers(parts["aperture"], aperture) || (!aperture.empty() && aperture.size() != 2))
    return "aperture: expected two numbers in [0, 1) with a comma between";
  if (!parseNumbers(parts["time"], time) || time.size() > 1)
    return "time: expected a number in [0, 1)";
  sample = {};
  if (!aperture.empty()) sample.aperture = {aperture[0], aperture[1]};
  if (!time.empty()) sample.time = time[0];
  std::copy(u.begin(), u.end(), sample.u.begin());
  std::copy(choice.begin(), choice.end(), sample.choice.begin());
  return "";
}

}  // namespace h2mc
