// SPDX-License-Identifier: MIT
#include "compare/comparison.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

namespace h2mc {
namespace {

std::vector<std::string> splitAtCommas(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

std::string fileNameFor(const std::string& text) {
  std::string name;
  for (const unsigned char c : text)
    name += std::isalnum(c) || std::string("=.,_-+").find(static_cast<char>(c)) != std::string::npos
                ? static_cast<char>(c)
                : '_';
  if (name.empty() || name[0] == '.') name = "_" + name;
  return name;
}

std::vector<std::string> splitMethods(const std::string& text) {
  std::vector<std::string> methods;
  for (const std::string& part : splitAtCommas(text)) {
    if (part.empty())
      throw ComparisonError("--integrators " + text +
                            ": there is an empty name between the commas");
    const std::size_t equals = part.find('='), colon = part.find(':');
    if (!methods.empty() && equals != std::string::npos && colon > equals)
      methods.back() += (methods.back().find(':') == std::string::npos ? ":" : ",") + part;
    else
      methods.push_back(part);
  }
  for (std::size_t i = 0; i < methods.size(); ++i)
    if (std::count(methods.begin(), methods.end(), methods[i]) > 1)
      throw ComparisonError("--integrators " + text + ": \"" + methods[i] + "\" is there twice");
  return methods;
}

std::vector<double> parseMarks(const std::string& text) {
  std::vector<double> marks;
  for (const std::string& part : splitAtCommas(text)) {
    char* end = nullptr;
    const double value = std::strtod(part.c_str(), &end);
    if (part.empty() || *end != '\0' || !std::isfinite(value) || value <= 0)
      throw ComparisonError("expected numbers above 0 with commas between, got \"" + text + "\"");
    if (!marks.empty() && value <= marks.back())
      throw ComparisonError("expected ascending numbers, got \"" + text + "\"");
    marks.push_back(value);
  }
  return marks;
}

std::vector<ComparedScene> namedScenes(const std::vector<std::string>& files) {
  std::vector<ComparedScene> scenes;
  for (const std::string& file : files) {
    const std::string stem = fileNameFor(std::filesystem::path(file).stem().string());
    std::string name = stem;
    const auto taken = [&] {
      return std::any_of(scenes.begin(), scenes.end(),
                         [&](const ComparedScene& scene) { return scene.name == name; });
    };
    for (int i = 2; taken(); ++i) name = stem + "-" + std::to_string(i);
    scenes.push_back({file, name});
  }
  return scenes;
}

}  // namespace h2mc
