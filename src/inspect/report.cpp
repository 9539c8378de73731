// SPDX-License-Identifier: MIT
#include "inspect/report.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <filesystem>

#include "compare/embed.h"
#include "inspect/film_preview.h"
#include "inspect/page_files.h"
#include "mcmc/render/integrator_choice.h"
#include "render/core/index.h"
#include "render/path/path_text.h"
#include "render/path/path_vertices.h"
#include "render/scene/kinds.h"

namespace h2mc {
namespace {

using nlohmann::json;

void append(std::vector<std::uint8_t>& bytes, std::uint32_t bits, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(bits >> 8 * i & 255));
}

json floats(const std::vector<float>& values, ArrayForm form) {
  if (form == ArrayForm::kNumbers) return values;
  std::vector<std::uint8_t> bytes;
  for (const float v : values) append(bytes, std::bit_cast<std::uint32_t>(v), 4);
  return base64(bytes);
}

json sliceJson(const Slice& slice, ArrayForm form) {
  json result{{"halfX", slice.halfX}, {"halfY", slice.halfY}, {"resolution", slice.resolution}};
  if (form == ArrayForm::kNumbers) {
    json ratios = json::array();
    for (const float v : slice.logRatio) ratios.push_back(std::isfinite(v) ? json(v) : json());
    result["logRatio"] = ratios;
    result["cells"] = slice.cells;
    return result;
  }
  std::vector<std::uint8_t> ratios, cells;
  for (const float v : slice.logRatio) append(ratios, halfBits(v), 2);
  for (const SliceCell c : slice.cells) cells.push_back(static_cast<std::uint8_t>(c));
  result["logRatio"] = base64(ratios);
  result["cells"] = base64(cells);
  return result;
}

// From the camera to the light.
std::vector<std::string> vertexNames(const Scene& scene, const Path& path) {
  const auto [s, t] = path.technique;
  std::vector<std::string> names{"camera"};
  const auto add = [&](const TracedVertex& v) {
    const Bsdf* const bsdf = bsdfSeen(scene, v);
    names.emplace_back(bsdf ? kindOf(*bsdf) : "black");
  };
  // With s = 0 the camera's last vertex is the light, or beyond the scene.
  for (int i = 1; i < (s == 0 ? t - 1 : t); ++i) add(path.camera[at(i)]);
  for (int i = s - 1; i >= 1; --i) add(path.light[at(i)]);
  if (path.lightIndex >= 0)
    names.emplace_back(std::string(kindOf(scene.lights[at(path.lightIndex)])) + " light");
  return names;
}

const char* nameOf(PathChoice choice) {
  switch (choice) {
    case PathChoice::kRidge:
      return "ridge";
    case PathChoice::kChain:
      return "chain";
    case PathChoice::kLargest:
      return "largest";
    case PathChoice::kGiven:
      return "given";
  }
  return "?";
}

json pathJson(const Scene& scene, const Inspection& inspection, const InspectSettings& settings) {
  const Path& path = inspection.path;
  const PathSearch& search = inspection.search;
  std::vector<float> coordinates(at(path.dimension()));
  pathCoordinates(path, coordinates.data());
  return {{"text", pathText(path.technique, path.sample)},
          {"s", path.technique.s},
          {"t", path.technique.t},
          {"edges", path.technique.length()},
          {"coordinates", coordinates},
          {"moving", path.moving},
          {"vertices", vertexNames(scene, path)},
          {"target", path.target},
          {"contribution", {path.contribution.x, path.contribution.y, path.contribution.z}},
          {"filmX", path.filmX},
          {"filmY", path.filmY},
          {"choice", nameOf(settings.choice)},
          {"search",
           {{"samples", search.samples},
            {"contributing", search.contributing},
            {"minLength", search.minLength},
            {"mutations", settings.mutations},
            {"accepted", search.accepted}}}};
}

json modelJson(const LocalModel& model) {
  json eigen = json::array();
  for (std::size_t i = 0; i < model.eigen.size(); ++i) {
    const EigenDirection& e = model.eigen[i];
    eigen.push_back({{"name", fmt::format("e{}", i + 1)},
                     {"value", e.value},
                     {"slope", e.slope},
                     {"deviation", e.deviation},
                     {"mean", e.mean},
                     {"vector", e.vector}});
  }
  std::vector<std::string> coordinates;
  for (const std::string& name : model.names())
    if (name[0] != 'e') coordinates.push_back(name);
  return {{"available", model.available},  {"reason", model.reason},
          {"dimension", model.dimension},  {"coordinateNames", coordinates},
          {"sigma", model.settings.sigma}, {"trajectoryLength", model.settings.trajectory},
          {"logTarget", model.logTarget},  {"gradient", model.gradient},
          {"hessian", model.hessian},      {"eigen", eigen}};
}

json kindJson(const ProposalKind& kind, int dimension, ArrayForm form) {
  // Those without an offset have NaN for it, which only base64 can hold.
  std::vector<float> film, offsets, acceptance;
  std::vector<int> accepted;
  json lists = json::array();
  for (const InspectedProposal& p : kind.proposals) {
    film.push_back(p.filmX);
    film.push_back(p.filmY);
    acceptance.push_back(static_cast<float>(p.acceptance));
    accepted.push_back(p.accepted);
    if (form == ArrayForm::kNumbers)
      lists.push_back(p.offset.empty() ? json() : json(p.offset));
    else if (p.offset.empty())
      offsets.insert(offsets.end(), static_cast<std::size_t>(dimension), std::nanf(""));
    else
      offsets.insert(offsets.end(), p.offset.begin(), p.offset.end());
  }
  return {{"name", kind.name},
          {"count", kind.proposals.size()},
          {"acceptance", kind.acceptance},
          {"jump", kind.jump},
          {"filmJump", kind.filmJump},
          {"jumpAlong", kind.jumpAlong},
          {"dark", kind.dark},
          {"otherTechnique", kind.other},
          {"unknownOffset", kind.unknown},
          {"film", floats(film, form)},
          {"acceptances", floats(acceptance, form)},
          {"accepted", accepted},
          {"offsets", form == ArrayForm::kNumbers ? lists : floats(offsets, form)}};
}

}  // namespace

json inspectionJson(const Scene& scene, const Inspection& inspection, const OptionSet& options,
                    const InspectSettings& settings, ArrayForm form) {
  json pairs = json::array(), kinds = json::array();
  for (const InspectedPair& pair : inspection.pairs) {
    pairs.push_back({{"x", pair.x.name},
                     {"y", pair.y.name},
                     {"wide", sliceJson(pair.wide, form)},
                     {"close", sliceJson(pair.close, form)}});
    if (form == ArrayForm::kNumbers) break;
  }
  for (const ProposalKind& kind : inspection.kinds)
    kinds.push_back(kindJson(kind, inspection.model.dimension, form));
  json film{{"width", inspection.film.width}, {"height", inspection.film.height}};
  if (form == ArrayForm::kBase64)
    film["pixels"] = base64Srgb(inspection.film, whiteScale(inspection.film, kNoisy));
  return {{"scene", std::filesystem::path(scene.file).filename().string()},
          {"pixel", {inspection.pixelX, inspection.pixelY}},
          {"width", scene.film.width},
          {"height", scene.film.height},
          {"seed", settings.seed},
          {"integrator", options.integrator()},
          {"options", optionText(options)},
          {"path", pathJson(scene, inspection, settings)},
          {"model", modelJson(inspection.model)},
          {"film", film},
          {"pairs", pairs},
          {"kinds", kinds}};
}

std::string inspectionTable(const Scene& scene, const Inspection& inspection,
                            const OptionSet& options) {
  const Path& path = inspection.path;
  const LocalModel& model = inspection.model;
  std::string text =
      fmt::format("pixel {},{}: technique s={} t={}, {} edges, {} coordinates, target {:.4g}\n",
                  inspection.pixelX, inspection.pixelY, path.technique.s, path.technique.t,
                  path.technique.length(), path.dimension(), path.target);
  std::string names;
  for (const std::string& name : vertexNames(scene, path))
    names += (names.empty() ? "" : " - ") + name;
  text += fmt::format("{}\n{}\n\n", names, pathText(path.technique, path.sample));
  if (model.available) {
    // Where a kind's jumps go says most of it, but for large steps, which have no scale.
    text += fmt::format("{:<4} {:>11} {:>11} {:>11} {:>11} {:>11}", "", "eigenvalue", "length",
                        "slope", "deviation", "drift");
    for (const ProposalKind& kind : inspection.kinds)
      if (kind.name != "large") text += fmt::format(" {:>20}", kind.name + " jump");
    text += '\n';
    for (std::size_t i = 0; i < model.eigen.size(); ++i) {
      const EigenDirection& e = model.eigen[i];
      text += fmt::format("{:<4} {:>11.4g} {:>11.4g} {:>11.4g} {:>11.4g} {:>11.4g}",
                          fmt::format("e{}", i + 1), e.value, 1 / std::sqrt(std::abs(e.value)),
                          e.slope, e.deviation, e.mean);
      for (const ProposalKind& kind : inspection.kinds)
        if (kind.name != "large") text += fmt::format(" {:>20.4g}", kind.jumpAlong[i]);
      text += '\n';
    }
  } else {
    text += fmt::format("No quadratic approximation here: {}. {} takes steps from the prior.\n",
                        model.reason, options.integrator());
  }
  text += fmt::format("\n{:<20} {:>10} {:>10} {:>12} {:>12} {:>10} {:>10}\n", "mutation",
                      "proposals", "acceptance", "jump", "jump, pixels", "dark", "elsewhere");
  for (const ProposalKind& kind : inspection.kinds)
    text += fmt::format("{:<20} {:>10} {:>10.3f} {:>12.4g} {:>12.4g} {:>10} {:>10}\n", kind.name,
                        kind.proposals.size(), kind.acceptance, kind.jump, kind.filmJump, kind.dark,
                        kind.other);
  return text;
}

std::string inspectionPage(const json& report) {
  return filledPage(page::kInspectHtml, page::kInspectStyle, page::kInspectScript, report);
}

}  // namespace h2mc
