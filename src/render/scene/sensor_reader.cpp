// SPDX-License-Identifier: MIT
// The camera, its film and its sampler.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "render/scene/change_note.h"
#include "render/scene/element_properties.h"
#include "render/scene/part_readers.h"
#include "render/scene/ranges.h"
#include "render/scene/sensor_plugins.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

constexpr float kNarrowest = 1e-4f, kWidest = 179.9f;  // field of view, degrees
constexpr float kFarthest = 1e30f;                     // clipping plane

constexpr Parameter kSampler[] = {{"sampleCount", ParameterType::kInteger, "0",
                                   "samples a pixel where the command line gives no budget"}};

Filter readFilter(ReaderContext& context, const XmlElement& element) {
  const SensorPlugin& entry = findPlugin(filterPlugins(), element, "reconstruction filter");
  const ElementProperties p(context, element, {"rfilter", entry.parameters, 0, {}, false});
  Filter filter;
  if (entry.name == "box") {
    filter.kind = Filter::Kind::kBox;
    filter.radius = numberIn(p, "radius", Filter::kNarrowest, Filter::kWidest);
  } else if (entry.name == "tent") {
    filter.kind = Filter::Kind::kTent;
    filter.radius = numberIn(p, "radius", Filter::kNarrowest, Filter::kWidest);
  } else if (entry.name == "gaussian") {
    filter.kind = Filter::Kind::kGaussian;
    filter.stddev = numberIn(p, "stddev", Filter::kNarrowest / Filter::kDeviations,
                             Filter::kWidest / Filter::kDeviations);
    filter.radius = Filter::kDeviations * filter.stddev;
  } else {
    filter.kind = Filter::Kind::kMitchell;
    filter.radius = 2;
    const bool spline = entry.name == "catmullrom";
    filter.b = spline ? 0.f : numberIn(p, "B", 0, 1);
    filter.c = spline ? 0.5f : numberIn(p, "C", 0, 1);
  }
  return filter;
}

Filter defaultFilter() {
  Filter filter;
  filter.kind = Filter::Kind::kGaussian;
  filter.radius = Filter::kDeviations * filter.stddev;
  return filter;
}

// The image's size after what the command line asks for.
void resize(FilmSettings& film, const ReadOptions& options, const ElementProperties* p) {
  double width = film.width, height = film.height;
  if (options.width > 0 && options.height > 0) {
    width = options.width;
    height = options.height;
  } else if (options.width > 0) {
    height = height * options.width / width;
    width = options.width;
  } else if (options.height > 0) {
    width = width * options.height / height;
    height = options.height;
  }
  if (options.scale > 0) {
    width *= options.scale;
    height *= options.scale;
  }
  width = std::max(1.0, std::round(width));
  height = std::max(1.0, std::round(height));
  constexpr double kLargest = 65536, kMostPixels = 1 << 28;
  if (!(width <= kLargest && height <= kLargest && width * height <= kMostPixels)) {
    const std::string message =
        fmt::format("the image would have {:.0f} x {:.0f} pixels", width, height);
    const std::string expected = fmt::format(
        "expected at most {:.0f} in width and height, and {:.0f} in all", kLargest, kMostPixels);
    const std::string_view place = film.width >= film.height ? "width" : "height";
    const bool asked = options.width > 0 || options.height > 0 || options.scale > 0;
    if (p && p->given(place) && !asked) p->fail(place, message, expected);
    throw SceneError("error: " + message + "\n" + expected);
  }
  film.width = static_cast<int>(width);
  film.height = static_cast<int>(height);
}

// The part of the film that is rendered, by its corners in the coordinates of the whole.
struct Window {
  double left = 0, top = 0, right = 1, bottom = 1;
};

// The part of a window that the crop is, once the film is of the size that the image would have; the film becomes the
// part.
Window croppedTo(const PixelRectangle& crop, const Window& window, FilmSettings& film) {
  const bool inside = crop.x >= 0 && crop.y >= 0 && crop.width > 0 && crop.height > 0 &&
                      crop.x <= film.width - crop.width && crop.y <= film.height - crop.height;
  if (!inside)
    throw SceneError(
        fmt::format("error: the window of {} x {} pixels at ({}, {}) is not within the image\n"
                    "expected a part of {} x {} pixels",
                    crop.width, crop.height, crop.x, crop.y, film.width, film.height));
  const double stepX = (window.right - window.left) / film.width;
  const double stepY = (window.bottom - window.top) / film.height;
  film.width = crop.width;
  film.height = crop.height;
  return {window.left + stepX * crop.x, window.top + stepY * crop.y,
          window.left + stepX * (crop.x + crop.width), window.top + stepY * (crop.y + crop.height)};
}

// The same in pixels.
FilmWindow inPixels(const Window& window, const FilmSettings& film) {
  if (window.right - window.left >= 1 && window.bottom - window.top >= 1) return {};
  const auto fit = [](double from, double to, int size, int& offset, int& whole) {
    whole = std::max(size, static_cast<int>(std::lround(size / (to - from))));
    offset = std::clamp(static_cast<int>(std::lround(from * whole)), 0, whole - size);
  };
  FilmWindow result;
  fit(window.left, window.right, film.width, result.x, result.wholeWidth);
  fit(window.top, window.bottom, film.height, result.y, result.wholeHeight);
  return result;
}

// The window that the film's crop parameters give; the film becomes the window.
Window readWindow(const ElementProperties& p, FilmSettings& film) {
  const int width = film.width, height = film.height;
  const int x = p.integer("cropOffsetX"), y = p.integer("cropOffsetY");
  film.width = p.given("cropWidth") ? p.integer("cropWidth") : width;
  film.height = p.given("cropHeight") ? p.integer("cropHeight") : height;
  const auto check = [&](const char* offset, const char* size, int first, int count, int all) {
    if (first >= 0 && count > 0 && first <= all - count) return;
    p.fail(p.given(size) ? size : offset,
           fmt::format("the part rendered, {} pixels from {} on, is not within the film's {}",
                       count, first, all));
  };
  check("cropOffsetX", "cropWidth", x, film.width, width);
  check("cropOffsetY", "cropHeight", y, film.height, height);
  return {double(x) / width, double(y) / height, double(x + film.width) / width,
          double(y + film.height) / height};
}

FilmSettings readFilm(ReaderContext& context, const XmlElement& element, const ReadOptions& options,
                      Window& window) {
  const SensorPlugin& entry = findPlugin(filmPlugins(), element, "film");
  // Labels and metadata may have any names, "label[10, 10]".
  XmlElement copy = element;
  std::erase_if(copy.children, [&](const XmlElement& child) {
    const std::string name = child.attribute("name");
    const bool text = name.rfind("label[", 0) == 0 || name.rfind("metadata[", 0) == 0;
    if (text) context.note("accepted and not used: labels and metadata of the film");
    return text;
  });
  const ElementProperties p(context, copy, {"film", entry.parameters, 0, {"rfilter"}, false});
  FilmSettings film;
  constexpr int kMost = std::numeric_limits<int>::max();
  film.width = integerIn(p, "width", 1, kMost);
  film.height = integerIn(p, "height", 1, kMost);
  window = readWindow(p, film);
  resize(film, options, &p);
  film.filter = defaultFilter();
  const XmlElement* filter = nullptr;
  for (const XmlElement& child : copy.children) {
    const XmlElement& target = context.resolve(child);
    if (target.name != "rfilter") continue;
    if (filter) throw sourceError(child.place(), "a second filter");
    filter = &target;
    film.filter = readFilter(context, target);
  }
  return film;
}

int readSampler(ReaderContext& context, const XmlElement& element) {
  // The kind does not matter: every sampler's parameters are accepted.
  const ElementProperties p(context, element, {"sampler", kSampler, 0, {}, true});
  context.note("accepted and not used: the kind of sampler, \"" + p.type() + "\"");
  return integerIn(p, "sampleCount", 0, std::numeric_limits<int>::max());
}

// What a thin lens has more than a pinhole.
void readLens(const ElementProperties& p, Camera& camera) {
  if (!p.given("apertureRadius"))
    p.fail("apertureRadius", "\"apertureRadius\" is missing",
           "expected the radius of the lens, 0 for a pinhole");
  const float radius = numberIn(p, "apertureRadius", 0, kFarthest);
  const float distance =
      p.given("focusDistance") ? numberAbove0(p, "focusDistance", kFarthest) : camera.farClip;
  if (radius > 0) camera.focus(radius, distance);
}

// Field of view of a 35 mm film's diagonal, degrees.
float fovOfFocalLength(const ElementProperties& p) {
  std::string text = p.string("focalLength");
  if (text.size() > 2 && text.substr(text.size() - 2) == "mm") text.resize(text.size() - 2);
  double length = 0;
  try {
    length = parseNumber(text);
  } catch (const ValueError& e) {
    p.fail("focalLength", e.what(), "expected a length like 50mm");
  }
  const double fov = glm::degrees(2 * std::atan(std::hypot(36.0, 24.0) / (2 * length)));
  if (!(length > 0 && fov >= kNarrowest && fov <= kWidest))
    p.fail(
        "focalLength",
        fmt::format("\"focalLength\" is {:g} mm, expected a length from 0.05 mm to 20 km", length));
  return static_cast<float>(fov);
}

// aspect: of the whole film.
Camera perspectiveCamera(const ElementProperties& p, const Motion& motion, float aspect) {
  if (p.given("fov") && p.given("focalLength"))
    p.fail("focalLength", "the sensor has both fov and focalLength", "expected one of them");
  float fov = 0;
  auto axis = Camera::FovAxis::kDiagonal;
  if (p.given("fov")) {
    fov = numberIn(p, "fov", kNarrowest, kWidest);
    const std::string name = p.string("fovAxis");
    axis = name == "x"          ? Camera::FovAxis::kX
           : name == "y"        ? Camera::FovAxis::kY
           : name == "diagonal" ? Camera::FovAxis::kDiagonal
           : name == "smaller"  ? Camera::FovAxis::kSmaller
                                : Camera::FovAxis::kLarger;
  } else {
    fov = fovOfFocalLength(p);
  }
  for (int i = 0; i < 3; ++i) {
    constexpr double kRounding = 1e-3;  // of matrices written with few digits
    const double scale = glm::length(glm::dvec3(motion.at(0)[i]));
    if (std::abs(scale - 1) > kRounding)
      noteChange(p, "toWorld", fmt::format("a scale of {:g}", scale), "none: a camera has no size");
  }
  return Camera(Mat4(motion.at(0)), fov, axis, aspect);
}

// Whose film is [-1, 1] x [-1 / aspect, 1 / aspect] before the transform.
Camera parallelCamera(const Motion& motion, float aspect) {
  const glm::dmat4 toWorld = motion.at(0);
  return Camera::parallel(Mat4(toWorld), static_cast<float>(glm::length(glm::dvec3(toWorld[0]))),
                          static_cast<float>(glm::length(glm::dvec3(toWorld[1]))) / aspect);
}

}  // namespace

void readSensor(ReaderContext& context, const XmlElement& element, const ReadOptions& options) {
  Scene& scene = context.scene;
  const SensorPlugin& entry = findPlugin(sensorPlugins(), element, "sensor");
  const ElementProperties p(context, element,
                            {"sensor", entry.parameters, 0, {"film", "sampler", "medium"}, false});
  const XmlElement* film = nullptr;
  const XmlElement* sampler = nullptr;
  for (const XmlElement& child : element.children) {
    const XmlElement& target = context.resolve(child);
    if (target.name == "medium")
      context.problems.refuse(child.place(), "participating media are not supported",
                              "the camera is in empty space");
    const XmlElement** slot = target.name == "film"      ? &film
                              : target.name == "sampler" ? &sampler
                                                         : nullptr;
    if (!slot) continue;
    if (*slot) throw sourceError(child.place(), "a second " + target.name + " of the sensor");
    *slot = &target;
  }
  Window window;
  if (film) {
    scene.film = readFilm(context, *film, options, window);
  } else {
    scene.film.filter = defaultFilter();
    resize(scene.film, options, nullptr);
  }
  if (options.crop) window = croppedTo(*options.crop, window, scene.film);
  if (options.window) *options.window = inPixels(window, scene.film);
  if (sampler) scene.samplesPerPixel = readSampler(context, *sampler);

  // Of the whole film: fov is for that.
  const float part = static_cast<float>(scene.film.width) / static_cast<float>(scene.film.height);
  const double windowX = window.right - window.left, windowY = window.bottom - window.top;
  const float aspect = static_cast<float>(part * windowY / windowX);
  const float shutterOpen = p.number("shutterOpen"), shutterClose = p.number("shutterClose");
  if (shutterClose < shutterOpen) p.fail("shutterClose", "the shutter closes before it opens");
  scene.camera.shutterOpen = shutterOpen;  // what motion() goes by
  scene.camera.shutterClose = shutterClose;
  const Motion motion = p.motion("toWorld");
  scene.camera = entry.name == "orthographic" ? parallelCamera(motion, aspect)
                                              : perspectiveCamera(p, motion, aspect);
  double shiftX = 0, shiftY = 0;
  if (!scene.camera.isParallel()) {
    constexpr float kFarthestOff = 100;
    shiftX = numberIn(p, "principalPointOffsetX", -kFarthestOff, kFarthestOff);
    shiftY = numberIn(p, "principalPointOffsetY", -kFarthestOff, kFarthestOff);
  }
  if (windowX < 1 || windowY < 1 || shiftX != 0 || shiftY != 0)
    scene.camera.crop(window.left + shiftX, window.top + shiftY, window.right + shiftX,
                      window.bottom + shiftY);
  scene.camera.follow(motion);
  scene.camera.shutterOpen = shutterOpen;
  scene.camera.shutterClose = shutterClose;
  scene.camera.nearClip = numberAbove0(p, "nearClip", kFarthest);
  scene.camera.farClip = numberAbove0(p, "farClip", kFarthest);
  if (!(scene.camera.nearClip < scene.camera.farClip))
    p.fail("farClip", "farClip must be larger than nearClip");
  if (entry.name == "thinlens") readLens(p, scene.camera);
}

}  // namespace h2mc
