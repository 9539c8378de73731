// SPDX-License-Identifier: MIT
#include "render_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fuzz_target.h"
#include "mcmc/chain/statistics.h"
#include "mcmc/render/integrator_choice.h"
#include "render/core/random.h"
#include "render/scene/kinds.h"

namespace h2mc::fuzz {
namespace {

constexpr int kRuns = 8;
constexpr double kDeviations = 8, kMargin = 0.1;
// Errors above this share of the mean say little.
constexpr double kResolved = 0.1;

struct Brightness {
  double mean = 0, error = 0;
};

// With as few samples as there can be in what an integrator does before it begins.
std::string wish(const std::string& integrator) {
  if (integrator == "path" || integrator == "bdpt") return integrator;
  return integrator + ":chains=8,bootstrapSamples=2000";
}

void checkImage(const RenderResult& result, const std::string& integrator) {
  for (int y = 0; y < result.image.height; ++y)
    for (int x = 0; x < result.image.width; ++x) {
      const Rgbf& p = result.image.at(x, y);
      for (int c = 0; c < 3; ++c)
        if (!(std::isfinite(p[c]) && p[c] >= 0))
          throw Finding(fmt::format("{}: pixel {},{} is {}", integrator, x, y, p[c]));
    }
}

Brightness render(const Scene& scene, const std::string& integrator, long long perPixel,
                  std::uint64_t seed) {
  const IntegratorChoice choice = chooseIntegrator(wish(integrator), scene);
  RenderRequest request;
  request.budget.samplesPerPixel = perPixel;
  request.threads = 1;
  request.seed = seed;
  const RenderResult result = choice.integrator->render(scene, request);
  checkImage(result, integrator);
  return {result.meanLuminance, result.meanLuminanceError};
}

Brightness meanOf(const Scene& scene, const std::string& integrator, long long perPixel,
                  std::uint64_t seed) {
  Moments moments;
  for (int run = 0; run < kRuns; ++run)
    moments.add(
        render(scene, integrator, perPixel, mixBits(seed) + static_cast<std::uint64_t>(run)).mean);
  return {moments.mean(), moments.standardError()};
}

bool resolved(const Brightness& b) { return b.error <= kResolved * b.mean; }

bool brighter(const Brightness& a, const Brightness& b) {
  return resolved(a) && resolved(b) &&
         a.mean - b.mean > kDeviations * std::hypot(a.error, b.error) + kMargin * b.mean;
}

// Whether path has no way to miss what is bright: see the header.
bool isTame(const Scene& scene) {
  constexpr float kSmall = 0.05f;  // of the scene's radius
  for (const Bsdf& bsdf : scene.bsdfs)
    if (!std::holds_alternative<Diffuse>(bsdf)) return false;
  for (const Material& material : scene.materials)
    if (material.opacity || material.blend || material.frame) return false;
  for (const Light& light : scene.lights) {
    const std::string_view kind = kindOf(light);
    if (kind != "area" && kind != "constant") return false;
  }
  for (std::size_t i = 0; i < scene.shapes.size(); ++i)
    if (scene.shapes[i].light >= 0 &&
        boundsOf(std::span(scene.shapes).subspan(i, 1)).radius < kSmall * scene.bounds.radius)
      return false;
  return true;
}

// What is wrong between the three; "" if nothing.
std::string disagreement(const Scene& scene, const Brightness& path, const Brightness& bdpt,
                         const Brightness& h2mc) {
  const char* what = brighter(h2mc, bdpt)                    ? "h2mc is brighter than bdpt"
                     : brighter(bdpt, h2mc)                  ? "h2mc is darker than bdpt"
                     : brighter(path, bdpt)                  ? "path is brighter than bdpt"
                     : isTame(scene) && brighter(bdpt, path) ? "path is darker than bdpt"
                                                             : "";
  if (!*what) return "";
  return fmt::format("{}: path {:.6g} +- {:.2g}, bdpt {:.6g} +- {:.2g}, h2mc {:.6g} +- {:.2g}",
                     what, path.mean, path.error, bdpt.mean, bdpt.error, h2mc.mean, h2mc.error);
}

}  // namespace

void checkRender(const Scene& scene) {
  const Brightness path = render(scene, "path", 8, 1), h2mc = render(scene, "h2mc", 8, 1);
  const std::string& own = scene.integrator.integrator();
  if (!own.empty() && own != "path" && own != "h2mc") render(scene, own, 4, 1);
  if (!brighter(path, h2mc) && !brighter(h2mc, path)) return;

  std::string what;
  for (const std::uint64_t seed : {2, 3}) {
    const auto mean = [&](const char* integrator) { return meanOf(scene, integrator, 16, seed); };
    what = disagreement(scene, mean("path"), mean("bdpt"), mean("h2mc"));
    if (what.empty()) return;
  }
  throw Finding(what);
}

}  // namespace h2mc::fuzz
