// SPDX-License-Identifier: MIT
#include "compare/setup.h"

#include <fmt/format.h>

#include <map>

#include "compare/reference.h"
#include "mcmc/render/integrators.h"
#include "render/core/input_file.h"
#include "render/scene/scene_reader.h"

namespace h2mc {
namespace {

std::map<std::string, std::string> definesOf(const ComparisonPlan& plan) {
  std::map<std::string, std::string> defines;
  for (const std::string& define : plan.defines) {
    const std::size_t equals = define.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw ComparisonError("-D " + define + ": expected name=value");
    defines[define.substr(0, equals)] = define.substr(equals + 1);
  }
  return defines;
}

}  // namespace

std::string hashOf(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const unsigned char c : text) hash = (hash ^ c) * 0x100000001b3ull;
  return fmt::format("{:016x}", hash);
}

std::filesystem::path runsFolder(const ComparisonPlan& plan, const ComparedScene& scene) {
  return plan.folder / "runs" / scene.name;
}

nlohmann::json runKey(const ComparisonPlan& plan, const ComparisonSetup::OneScene& scene,
                      const OptionSet& integrator) {
  return {{"programVersion", plan.programVersion},
          {"scene", scene.hash},
          {"defines", plan.defines},
          {"width", scene.scene.film.width},
          {"height", scene.scene.film.height},
          {"integrator", integrator.integrator()},
          {"options", optionText(integrator)},
          {"threads", plan.threads}};
}

ComparisonSetup setUp(const ComparisonPlan& plan) {
  for (const std::string& method : plan.methods) checkIntegratorWish(method);
  std::vector<IntegratorPlugin> plugins;
  for (const IntegratorFactory& factory : allIntegrators()) plugins.push_back(factory.plugin);
  ReadOptions read;
  read.defines = definesOf(plan);
  read.integrators = plugins;
  read.width = plan.width;
  read.height = plan.height;
  read.scale = plan.scale;
  read.confine = plan.confine;
  read.strictness = plan.permissive ? Strictness::kPermissive : Strictness::kByVersion;
  ComparisonSetup setup;
  for (const ComparedScene& scene : plan.scenes) {
    ComparisonSetup::OneScene one{
        readScene(scene.file, read), hashOf(InputFile(scene.file, kLargestText).whole()), {}};
    const FilmSettings& film = one.scene.film;
    if (const auto size = sizeForReference(plan, scene, film.width, film.height)) {
      ReadOptions atSize = read;
      atSize.width = size->x;
      atSize.height = size->y;
      one.scene = readScene(scene.file, atSize);
    }
    for (const std::string& method : plan.methods)
      one.methods.push_back(chooseIntegrator(method, one.scene));
    setup.scenes.push_back(std::move(one));
  }
  return setup;
}

}  // namespace h2mc
