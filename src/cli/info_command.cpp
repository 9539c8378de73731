// SPDX-License-Identifier: MIT
// h2mc info
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <set>

#include "cli/commands.h"
#include "cli/statistics_table.h"
#include "render/image/image_io.h"
#include "render/scene/change_note.h"
#include "render/scene/kinds.h"
#include "render/scene/scene.h"
#include "render/scene/scene_reader.h"

namespace h2mc {
namespace {

struct InfoOptions {
  std::string scene, confine;
  std::vector<std::string> defines;
  bool permissive = false, strict = false;
};

const char* nameOf(Filter::Kind kind) {
  switch (kind) {
    case Filter::Kind::kBox:
      return "box";
    case Filter::Kind::kTent:
      return "tent";
    case Filter::Kind::kGaussian:
      return "gaussian";
    case Filter::Kind::kMitchell:
      return "mitchell";
  }
  return "?";
}

std::string text(const Vec3f& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

void line(const char* name, const std::string& content) { fmt::print("{:<14}{}\n", name, content); }

// "3 area, 1 envmap"
std::string text(const std::map<std::string, long long>& counts) {
  std::string result;
  for (const auto& [name, count] : counts)
    result += fmt::format("{}{} {}", result.empty() ? "" : ", ", withSeparators(count), name);
  return result.empty() ? "none" : result;
}

void printGeometry(const Scene& scene) {
  std::map<std::string, long long> kinds;
  long long triangles = 0, vertices = 0;
  std::set<const SharedMesh*> meshes;
  for (const Shape& shape : scene.shapes) {
    ++kinds[kindOf(shape)];
    // What instances share is there once.
    const SharedMesh* const shared = shape.sharedMesh();
    if (shared && !meshes.insert(shared).second) continue;
    triangles += static_cast<long long>(shape.triangles().size());
    if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry))
      vertices += static_cast<long long>(mesh->positions.size());
    else if (const auto* moving = std::get_if<MovingMesh>(&shape.geometry))
      vertices += static_cast<long long>(moving->vertices());
    else if (shared)
      vertices += static_cast<long long>(shared->mesh.positions.size());
  }
  line("shapes", fmt::format("{} ({})", withSeparators(static_cast<long long>(scene.shapes.size())),
                             text(kinds)));
  line("triangles",
       fmt::format("{}, {} vertices", withSeparators(triangles), withSeparators(vertices)));
  line("bounds",
       fmt::format("centre {}, radius {:.6g}", text(scene.bounds.center), scene.bounds.radius));
}

void printMaterials(const Scene& scene) {
  std::map<std::string, long long> kinds;
  long long twosided = 0, masked = 0;
  for (const Bsdf& bsdf : scene.bsdfs) ++kinds[kindOf(bsdf)];
  for (const Material& material : scene.materials) {
    twosided += material.twosided;
    masked += material.opacity != nullptr;
  }
  std::string more;
  if (twosided > 0) more += fmt::format(", {} two-sided", twosided);
  if (masked > 0) more += fmt::format(", {} with opacity", masked);
  line("materials", fmt::format("{}{}", scene.materials.size(), more));
  line("bsdfs", fmt::format("{} ({})", scene.bsdfs.size(), text(kinds)));
}

void printLights(const Scene& scene) {
  std::map<std::string, long long> kinds;
  for (const Light& light : scene.lights) ++kinds[kindOf(light)];
  line("lights", fmt::format("{} ({})", scene.lights.size(), text(kinds)));
}

void printCamera(const Scene& scene) {
  const Camera& camera = scene.camera;
  std::string kind = camera.isParallel() ? "orthographic" : "perspective";
  if (camera.hasAperture())
    kind = fmt::format("thin lens of radius {:g}, in focus at {:g},", camera.apertureRadius(),
                       camera.focusDistance());
  line("camera",
       fmt::format("{} at {} towards {}", kind, text(camera.position()), text(camera.forward())));
  line("clipping", fmt::format("{:g} to {:g}", camera.nearClip, camera.farClip));
  line("shutter", fmt::format("{:g} to {:g}", camera.shutterOpen, camera.shutterClose));
  const FilmSettings& film = scene.film;
  line("film", fmt::format("{} x {}, {} filter of radius {:g}", film.width, film.height,
                           nameOf(film.filter.kind), film.filter.radius));
}

void printMotion(const Scene& scene) {
  if (!scene.moving) {
    line("moving", "no");
    return;
  }
  // Shapes by the number of steps into which their motion is cut.
  std::map<int, long long> steps;
  long long shapes = 0;
  for (const Shape& shape : scene.shapes) {
    if (!shape.moves()) continue;
    ++shapes;
    ++steps[shape.motionSegments()];
  }
  std::string content;
  if (shapes > 0) {
    content = fmt::format("{} {} (", withSeparators(shapes), shapes == 1 ? "shape" : "shapes");
    for (const auto& [segments, count] : steps) {
      if (content.back() != '(') content += ", ";
      content += fmt::format("{} in {} {}", withSeparators(count), segments,
                             segments == 1 ? "step" : "steps");
    }
    content += ")";
  }
  if (scene.camera.moves()) content += content.empty() ? "the camera" : ", the camera";
  line("moving", content);
}

void printIntegrator(const OptionSet& integrator) {
  if (integrator.integrator().empty()) {
    line("integrator", "not given");
    return;
  }
  std::string options;
  for (const auto& [name, value] : integrator.values())
    if (integrator.given(name))
      options += fmt::format("{}{}={}", options.empty() ? ":" : ",", name, value);
  line("integrator", integrator.integrator() + options);
}

std::string text(const std::variant<std::string, double, int>& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

// Of an EXR, what its header says.
int imageInfo(const std::string& file) {
  const ExrHeader header = readExrHeader(file);
  line("image", file);
  line("size", fmt::format("{} x {}", header.width, header.height));
  const FilmWindow& window = header.window;
  if (window.isPart())
    line("window", fmt::format("from ({}, {}) on of {} x {}", window.x, window.y, window.wholeWidth,
                               window.wholeHeight));
  line("channels", fmt::format("{}", fmt::join(header.channels, ", ")));
  const std::vector<std::string> layers = layersOf(header);
  line("layers", layers.empty() ? "none" : fmt::format("{}", fmt::join(layers, ", ")));
  for (const auto& [name, value] : header.attributes) fmt::print("{:<20}{}\n", name, text(value));
  return kSuccess;
}

int info(const InfoOptions& options) {
  if (isExr(options.scene)) return imageInfo(options.scene);
  ReadOptions read = readOptionsOf(options.defines, options.permissive, options.confine);
  if (options.strict) read.strictness = Strictness::kStrict;
  const Scene scene = readScene(options.scene, read);
  printWarnings(scene);

  line("scene", options.scene);
  printGeometry(scene);
  printMaterials(scene);
  printLights(scene);
  printCamera(scene);
  printMotion(scene);
  printIntegrator(scene.integrator);
  std::vector<std::string> changes;
  for (const std::string& note : scene.notes)
    if (note.starts_with(kChangeNote))
      changes.push_back(note.substr(kChangeNote.size()));
    else
      line("note", note);
  if (!changes.empty()) fmt::print("\nChanged on the way in:\n");
  for (const std::string& change : changes) fmt::print("{}\n", change);
  return kSuccess;
}

}  // namespace

void addInfoCommand(CLI::App& app, Run& run) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command =
      app.add_subcommand("info", "What a scene file holds, as it was read; or an EXR's header");
  command->add_option("SCENE", options->scene, "Scene file (Mitsuba XML), or an EXR")
      ->required()
      ->type_name("FILE");
  addDefines(*command, options->defines);
  addLimits(*command);
  addPermissive(*command, options->permissive);
  addConfine(*command, options->confine);
  command->add_flag("--strict", options->strict, "Take every warning for an error")
      ->excludes("--permissive");
  command->footer(
      "What is not used, or left out because nothing needs it, is in the notes; parameters whose "
      "value is not used "
      "as it is in the file are at the end, under \"Changed on the way in\".");
  command->callback([options, &run] { run = [options] { return info(*options); }; });
}

}  // namespace h2mc
