// SPDX-License-Identifier: MIT
#include "mcmc/mutations/lens_step.h"

#include <algorithm>
#include <cmath>

#include "mcmc/mutations/mutation_options.h"
#include "render/bsdf/lobe_choice.h"
#include "render/core/index.h"
#include "render/path/lens_replay.h"
#include "render/path/reconnect.h"
#include "render/scene/option_set.h"

namespace h2mc {
LensStep::LensStep(const PathTarget& target, const Settings& settings, SlotNumbers& slots)
    : target_(target),
      settings_(settings),
      gaussian_(slots.add<Gaussian>()),
      sizes_(settings.targetAcceptance) {
  isotropicGaussian(2, settings.hamiltonian.sigma, round_);
}

bool LensStep::canReconnect(const TracedVertex& vertex) const {
  // A question to the material, not to the lobe: lobes are drawn anew, and the way back must find
  // the same answer.
  const Scene& scene = target_.scene();
  const Material& material = materialAt(scene, vertex.id);
  return !isDelta(scene.bsdfs, material, vertex.lobe) &&
         widestLobe(scene.bsdfs, material, vertex.lobe) >= settings_.threshold;
}

int LensStep::reconnectionVertex(const Path& path) const {
  const int last = path.technique.t - 1;
  for (int i = 1; i < last; ++i) {
    if (!canReconnect(path.camera[at(i)])) continue;
    if (i + 1 == last || canReconnect(path.camera[at(i) + 1])) return i;
  }
  return last;
}

double LensStep::logDensity(const Path& path, int reconnection) {
  // vcm is the reciprocal of the density per area (per solid angle of an edge that escapes). The
  // geometry factor of the second edge stays the same and cancels.
  const int last = path.technique.t - 1;
  double sum = 0;
  for (int i = reconnection + 1; i <= std::min(reconnection + 2, last); ++i)
    sum -= std::log(
        double(i == last && path.escaped ? path.lastRay.vcm : path.camera[at(i)].vertex.vcm));
  return sum;
}

bool LensStep::followKnown(Path& path, const Path& known, int i) const {
  const TracedVertex& next = known.camera[at(i) + 1];
  path.camera[at(i) + 1].lobe = next.lobe;
  const bool escapes = known.escaped && i + 1 == known.technique.t - 1;
  return follow(target_.scene(), path, Side::kCamera, i, escapes ? PrimitiveId{} : next.id);
}

const Gaussian& LensStep::gaussianAt(ChainState& state, int reconnection,
                                     MutationContext& context) const {
  if (!settings_.hessian) return round_;
  auto& [gaussian, known] = state.derived[gaussian_];
  if (known) return gaussian;
  known = true;
  Derivative derivative;
  ++context.derivatives.computed;
  differentiateLens(target_.scene(), state.path, reconnection, derivative);
  if (!hamiltonianGaussian(derivative, settings_.hamiltonian, gaussian))
    ++context.derivatives.notFinite;
  return gaussian;
}

Proposal LensStep::propose(ChainState& current, ChainState& proposed, MutationContext& context) {
  const Scene& scene = target_.scene();
  Random& random = *context.random;
  const Path& from = current.path;
  Path& to = proposed.path;
  const auto [s, t] = from.technique;
  const int last = t - 1;

  const int reconnection = reconnectionVertex(from);
  const Gaussian& gaussian = gaussianAt(current, reconnection, context);
  float offset[2];
  gaussian.sample(random, offset);
  const float size = sizes_.of(from.technique.length());
  const float filmX = from.sample.u[0] + size * offset[0],
              filmY = from.sample.u[1] + size * offset[1];
  if (!(filmX >= 0 && filmX < 1 && filmY >= 0 && filmY < 1)) return Proposal::none();

  to.technique = from.technique;
  to.sample = from.sample;
  to.sample.u[0] = filmX;
  to.sample.u[1] = filmY;
  to.wraps = from.wraps;
  to.escaped = false;
  to.lightIndex = from.lightIndex;
  to.lightPrimitive = from.lightPrimitive;
  if (s >= 2) std::copy_n(from.light.begin() + 1, s - 1, to.light.begin() + 1);

  // Trace up to the vertex from which the old path can be met again.
  for (int i = 1; i <= reconnection; ++i) {
    const Step step = stepCamera(scene, to, i);
    if (i > 1 && !(to.camera[at(i) - 1].lobe == from.camera[at(i) - 1].lobe))
      return Proposal::none();
    if (step == Step::kArrived) continue;
    to.escaped = step == Step::kEscaped && s == 0 && i == last && scene.hasEnvironment();
    if (!to.escaped) return Proposal::none();
  }

  if (reconnection < last) {
    // Two scatterings are aimed at what stays: at x_(i+1), and from there at x_(i+2).
    for (int i = reconnection; i < std::min(reconnection + 2, last); ++i) {
      const Vec3f& here = to.camera[at(i)].vertex.point.p;
      const bool escapes = from.escaped && i + 1 == last;
      const SurfacePoint<float>& next = from.camera[at(i) + 1].vertex.point;
      const Vec3f direction =
          escapes ? from.lastRay.direction : Vec3f(glm::normalize(next.p - here));
      if (!aim(scene, to, Side::kCamera, i, direction, random)) return Proposal::none();
      if (i == reconnection) {
        const SurfacePoint<float>& point = to.camera[at(i)].vertex.point;
        if (escapes ? !pointEscapes(scene, point, direction, to.sample.time)
                    : !pointsVisible(scene, point, next, to.sample.time))
          return Proposal::none();
      }
      if (!followKnown(to, from, i)) return Proposal::none();
    }
    for (int i = reconnection + 2; i < last; ++i)
      if (!followKnown(to, from, i)) return Proposal::none();
  }
  if (!joinSubpaths(scene, to) || !target_.weigh(to) || reconnectionVertex(to) != reconnection)
    return Proposal::none();
  double logRatio = logDensity(to, reconnection) - logDensity(from, reconnection);
  if (settings_.hessian) {
    const float back[2] = {-offset[0], -offset[1]};
    logRatio +=
        gaussianAt(proposed, reconnection, context).logDensity(back) - gaussian.logDensity(offset);
  }
  return Proposal::withLogRatio(logRatio);
}

MutationPlugin lensStep() {
  static constexpr Parameter kParameters[] = {
      {"lensSigma", ParameterType::kNumber, "0.01",
       "standard deviation of the lens perturbation, in film widths"},
      {"lensStep", ParameterType::kString, "isotropic",
       "what the lens perturbation draws from: a round Gaussian, or one shaped by the Hessian with "
       "respect to the film position",
       "isotropic|hessian"},
      kRoughnessThresholdParameter,
      kTargetAcceptanceParameter,
  };
  return {"lens", "the pixel moves a little, the path stays where it is as soon as it can",
          kParameters,
          [](const MutationSetup& setup) -> std::unique_ptr<Mutation> {
            LensStep::Settings settings;
            settings.hamiltonian.sigma = static_cast<float>(setup.options.number("lensSigma"));
            settings.hessian = setup.options.string("lensStep") == "hessian";
            settings.threshold = roughnessThreshold(setup.options);
            settings.targetAcceptance = setup.options.number("targetAcceptance");
            return std::make_unique<LensStep>(setup.target, settings, setup.slots);
          },
          [](const OptionSet& options) {
            requireRange(options, "lensSigma", 1e-9, 1);
            requireAcceptance(options);
          }};
}

}  // namespace h2mc
