// SPDX-License-Identifier: MIT
#include "compare/external.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "render/image/image_io.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

// Two times within this factor of each other are the same mark.
constexpr double kSameTime = 1.02;

bool isExr(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".exr";
}

std::vector<fs::path> filesOf(const ExternalMethod& method, const std::string& scene,
                              bool onlyScene) {
  const bool own = fs::is_directory(method.folder / scene);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(own ? method.folder / scene : method.folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && isExr(entry.path()) &&
        (own || onlyScene || name.find(scene) != std::string::npos))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::optional<double> numberOf(const ImageAttributes& attributes,
                               std::initializer_list<const char*> names) {
  for (const char* name : names) {
    const auto it = attributes.find(name);
    if (it == attributes.end()) continue;
    if (const auto* number = std::get_if<double>(&it->second)) return *number;
    if (const auto* whole = std::get_if<int>(&it->second)) return *whole;
    if (const auto* text = std::get_if<std::string>(&it->second)) {
      char* end = nullptr;
      const double value = std::strtod(text->c_str(), &end);
      if (end != text->c_str()) return value;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> secondsInName(const std::string& name) {
  static const std::regex pattern("(^|[^0-9.])([0-9]+(\\.[0-9]+)?) ?s(ec)?($|[^A-Za-z0-9])");
  std::optional<double> seconds;
  for (auto it = std::sregex_iterator(name.begin(), name.end(), pattern);
       it != std::sregex_iterator(); ++it)
    seconds = std::stod((*it)[2].str());
  return seconds;
}

ExternalMethod parseExternal(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
    throw ComparisonError("--external " + text + ": expected name=FOLDER");
  ExternalMethod method{text.substr(0, equals), text.substr(equals + 1)};
  if (!fs::is_directory(method.folder))
    throw ComparisonError("--external " + text + ": there is no folder \"" +
                          method.folder.string() + "\"");
  return method;
}

MethodRuns readExternal(const ExternalMethod& method, const SceneRuns& scene, bool onlyScene) {
  MethodRuns runs;
  runs.name = method.name;
  runs.external = true;
  std::vector<Point> points;
  for (const fs::path& file : filesOf(method, scene.scene.name, onlyScene)) {
    const Image image = readImage(file.string());
    if (image.width != scene.width || image.height != scene.height)
      throw ComparisonError(fmt::format(
          "--external {}: \"{}\" is {} x {}, the images of {} are {} x {}", method.name,
          file.string(), image.width, image.height, scene.scene.name, scene.width, scene.height));
    const ImageAttributes attributes = readAttributes(file.string());
    std::optional<double> seconds = numberOf(attributes, {"wallSeconds", "seconds", "time"});
    if (!seconds) seconds = secondsInName(file.stem().string());
    if (!seconds || !(*seconds > 0))
      throw ComparisonError(fmt::format(
          "--external {}: the time of \"{}\" is not known: give it as the attribute wallSeconds or "
          "in the name, as in {}-2.5s.exr",
          method.name, file.string(), scene.scene.name));
    Point point;
    point.mark = point.seconds = *seconds;
    point.cpuSeconds = numberOf(attributes, {"cpuSeconds"}).value_or(0);
    point.samples = numberOf(attributes, {"samples", "mutations"}).value_or(0);
    point.perPixel = point.samples / static_cast<double>(image.pixels.size());
    const auto unit = attributes.find("sampleUnit");
    if (unit != attributes.end())
      if (const auto* text = std::get_if<std::string>(&unit->second)) point.sampleUnit = *text;
    point.image = file;
    points.push_back(std::move(point));
  }
  if (points.empty())
    throw ComparisonError(fmt::format(
        "--external {}: no EXR files for the scene {} in \"{}\" (looked for a folder {} in it and "
        "for "
        "files with {} in their names)",
        method.name, scene.scene.name, method.folder.string(), scene.scene.name, scene.scene.name));
  std::stable_sort(points.begin(), points.end(),
                   [](const Point& a, const Point& b) { return a.seconds < b.seconds; });
  // The k-th image of each time belongs to the k-th repeat.
  std::size_t k = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    k = i > 0 && points[i].seconds < kSameTime * points[i - 1].seconds ? k + 1 : 0;
    if (runs.repeats.size() <= k) runs.repeats.push_back({k, {}});
    runs.repeats[k].points.push_back(points[i]);
  }
  return runs;
}

}  // namespace h2mc
