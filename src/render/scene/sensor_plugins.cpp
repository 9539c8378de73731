// SPDX-License-Identifier: MIT
#include "render/scene/sensor_plugins.h"

#include <algorithm>
#include <array>

namespace h2mc {
namespace {

using enum ParameterType;

constexpr Parameter kPerspective[] = {
    {"toWorld", kTransform, "", "from camera to world space"},
    {"fov", kNumber, "0", "field of view, 1e-4 to 179.9 degrees"},
    {"fovAxis", kString, "x", "the axis fov is measured along", "x|y|diagonal|smaller|larger"},
    {"focalLength", kString, "50mm", "instead of fov: focal length for 35 mm film"},
    {"nearClip", kNumber, "0.01", "nearest distance, above 0"},
    {"farClip", kNumber, "10000", "farthest distance, up to 1e30"},
    {"shutterOpen", kNumber, "0", "time"},
    {"shutterClose", kNumber, "0", "time"},
    {"principalPointOffsetX", kNumber, "0",
     "how far the film looks to the right of the axis, in its widths, -100 to 100"},
    {"principalPointOffsetY", kNumber, "0",
     "how far it looks below the axis, in its heights, -100 to 100"},
    ignoredParameter("focusDistance", kNumber)};
constexpr auto kThinLens = [] {
  constexpr std::size_t kOthers = std::size(kPerspective) - 1;
  std::array<Parameter, kOthers + 2> all{};
  std::copy_n(kPerspective, kOthers, all.begin());
  all[kOthers] = {"apertureRadius", kNumber, "", "of the lens, from 0 on; 0 is a pinhole"};
  all[kOthers + 1] = {"focusDistance", kNumber, "10000",
                      "of the plane in focus along the axis; farClip where it is not given"};
  return all;
}();
constexpr Parameter kOrthographic[] = {
    {"toWorld", kTransform, "", "from camera to world space; its scale is half the film's width"},
    {"nearClip", kNumber, "0.01", "nearest distance, above 0"},
    {"farClip", kNumber, "10000", "farthest distance, up to 1e30"},
    {"shutterOpen", kNumber, "0", "time"},
    {"shutterClose", kNumber, "0", "time"}};
constexpr SensorPlugin kSensors[] = {
    {"perspective", "a pinhole camera", kPerspective},
    {"thinlens", "a camera whose lens is in focus at one distance", kThinLens},
    {"orthographic", "a camera that sees along parallel rays", kOrthographic}};

constexpr Parameter kFilm[] = {{"width", kInteger, "768", "pixels"},
                               {"height", kInteger, "576", "pixels"},
                               {"cropOffsetX", kInteger, "0", "left edge of the part rendered"},
                               {"cropOffsetY", kInteger, "0", "upper edge of the part rendered"},
                               {"cropWidth", kInteger, "0", "of the part rendered; the width"},
                               {"cropHeight", kInteger, "0", "of the part rendered; the height"},
                               ignoredParameter("banner", kBoolean),
                               ignoredParameter("fileFormat", kString),
                               ignoredParameter("pixelFormat", kString),
                               ignoredParameter("componentFormat", kString),
                               ignoredParameter("attachLog", kBoolean),
                               ignoredParameter("highQualityEdges", kBoolean),
                               ignoredParameter("filename", kString),
                               ignoredParameter("gamma", kNumber),
                               ignoredParameter("exposure", kNumber),
                               ignoredParameter("key", kNumber),
                               ignoredParameter("burn", kNumber),
                               ignoredParameter("tonemapMethod", kString),
                               ignoredParameter("sampleBorder", kBoolean),
                               ignoredParameter("compensate", kBoolean)};
constexpr std::string_view kAnyFilm =
    "the image's size; the command line says what file is written";
constexpr SensorPlugin kFilms[] = {{"hdrfilm", kAnyFilm, kFilm},
                                   {"ldrfilm", kAnyFilm, kFilm},
                                   {"mfilm", kAnyFilm, kFilm},
                                   {"tiledhdrfilm", kAnyFilm, kFilm}};

constexpr Parameter kBox[] = {{"radius", kNumber, "0.5", "pixels, 0.5 to 32"}};
constexpr Parameter kTent[] = {{"radius", kNumber, "1", "pixels, 0.5 to 32"}};
constexpr Parameter kGaussian[] = {{"stddev", kNumber, "0.5", "pixels, 0.125 to 8"}};
constexpr Parameter kMitchell[] = {{"B", kNumber, "0.33333333", "0 to 1"},
                                   {"C", kNumber, "0.33333333", "0 to 1"}};
constexpr SensorPlugin kFilters[] = {
    {"box", "every sample counts the same", kBox},
    {"tent", "samples count less, linearly, the farther they are from the pixel's centre", kTent},
    {"gaussian", "a Gaussian less what it is at its border, 4 deviations away", kGaussian},
    {"mitchell", "Mitchell and Netravali's piecewise cubics", kMitchell},
    {"catmullrom", "mitchell with B = 0, C = 0.5", {}}};

}  // namespace

std::span<const SensorPlugin> sensorPlugins() { return kSensors; }
std::span<const SensorPlugin> filmPlugins() { return kFilms; }
std::span<const SensorPlugin> filterPlugins() { return kFilters; }

}  // namespace h2mc
