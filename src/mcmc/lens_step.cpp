#include "mcmc/lens_step.h"

#include <algorithm>
#include <cmath>

#include "render/bsdf/lobe_choice.h"
#include "render/path/lens_replay.h"
#include "render/scene/option_set.h"

namespace h2mc {
namespace {
std::size_t at(int i) { return static_cast<std::size_t>(i); }

bool dark(const Rgbf& c) { return !(c.x > 0) && !(c.y > 0) && !(c.z > 0); }
}  // namespace

std::unique_ptr<Mutation> makeLensStep(const SceneTarget& target, const OptionSet& options) {
  LensStep::Settings settings;
  settings.hamiltonian.sigma = static_cast<float>(options.number("lensSigma"));
  settings.hessian = options.string("lensStep") == "hessian";
  settings.threshold = static_cast<float>(options.number("roughnessThreshold"));
  return std::make_unique<LensStep>(target, settings);
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

bool LensStep::aim(Path& path, int i, const Vec3f& direction, Random& random) const {
  const Scene& scene = target_.scene();
  TracedVertex& v = path.camera[at(i)];
  const Material& material = materialAt(scene, v.id);
  const SurfacePoint<float>& point = v.vertex.point;
  const Vec3f wo = point.shading.toLocal(direction);
  if (!drawLobe(scene.bsdfs, material, point.uv, v.vertex.wi, wo, random.uniform(), v.lobe))
    return false;
  Vec2f u;
  if (!invertLobe(scene.bsdfs, material, point.uv, v.vertex.wi, wo, v.lobe, u)) return false;
  const auto k = at(path.technique.cameraCoordinate(i));
  path.sample.u[k] = u.x;
  path.sample.u[k + 1] = u.y;
  const ChoiceInterval choice =
      choiceInterval(scene.bsdfs, material, point.uv, v.vertex.wi, u.x, u.y, v.lobe);
  if (!(choice.end > choice.begin)) return false;
  path.sample.choice[at(path.technique.cameraChoice(i))] =
      std::min(choice.begin + (choice.end - choice.begin) * random.uniform(),
               std::nextafter(choice.end, 0.f));
  return true;
}

bool LensStep::follow(Path& path, const Path& known, int i) const {
  const Scene& scene = target_.scene();
  const TracedVertex& v = path.camera[at(i)];
  const auto k = at(path.technique.cameraCoordinate(i));
  const PathRay<float> ray = scatterFrom<float>(scene, v.vertex, v.id, v.lobe, path.sample.u[k],
                                                path.sample.u[k + 1], Side::kCamera);
  if (dark(ray.throughput)) return false;
  path.lastRay = ray;
  if (i + 1 == known.technique.t - 1 && known.escaped) {
    path.escaped = true;
    return true;
  }
  TracedVertex& next = path.camera[at(i) + 1];
  next.id = known.camera[at(i) + 1].id;
  next.lobe = known.camera[at(i) + 1].lobe;
  next.vertex = arriveAt<float>(scene, ray, next.id, &path.sample.time);
  return true;
}

void LensStep::prepare(ChainState& state, int reconnection, MutationContext& context) const {
  if (state.hasLens) return;
  state.hasLens = true;
  if (!settings_.hessian) {
    isotropicGaussian(2, settings_.hamiltonian.sigma, state.lens);
    return;
  }
  Derivative derivative;
  ++context.derivatives.computed;
  differentiateLens(target_.scene(), state.path, reconnection, derivative);
  if (!hamiltonianGaussian(derivative, settings_.hamiltonian, state.lens))
    ++context.derivatives.notFinite;
}

bool LensStep::propose(ChainState& current, ChainState& proposed, MutationContext& context,
                       double& logRatio) {
  const Scene& scene = target_.scene();
  Random& random = *context.random;
  const Path& from = current.path;
  Path& to = proposed.path;
  const auto [s, t] = from.technique;
  const int last = t - 1;

  const int reconnection = reconnectionVertex(from);
  prepare(current, reconnection, context);
  float offset[2];
  current.lens.sample(random, offset);
  const float filmX = from.sample.u[0] + offset[0], filmY = from.sample.u[1] + offset[1];
  if (!(filmX >= 0 && filmX < 1 && filmY >= 0 && filmY < 1)) return false;

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
    if (i > 1 && !(to.camera[at(i) - 1].lobe == from.camera[at(i) - 1].lobe)) return false;
    if (step == Step::kArrived) continue;
    to.escaped = step == Step::kEscaped && s == 0 && i == last && scene.environment >= 0;
    if (!to.escaped) return false;
  }

  if (reconnection < last) {
    // Two scatterings are aimed at what stays: at x_(i+1), and from there at x_(i+2).
    for (int i = reconnection; i < std::min(reconnection + 2, last); ++i) {
      const Vec3f& here = to.camera[at(i)].vertex.point.p;
      const bool escapes = from.escaped && i + 1 == last;
      const SurfacePoint<float>& next = from.camera[at(i) + 1].vertex.point;
      const Vec3f direction =
          escapes ? from.lastRay.direction : Vec3f(glm::normalize(next.p - here));
      if (!aim(to, i, direction, random)) return false;
      if (i == reconnection) {
        const SurfacePoint<float>& point = to.camera[at(i)].vertex.point;
        if (escapes ? !pointEscapes(scene, point, direction, to.sample.time)
                    : !pointsVisible(scene, point, next, to.sample.time))
          return false;
      }
      if (!follow(to, from, i)) return false;
    }
    for (int i = reconnection + 2; i < last; ++i)
      if (!follow(to, from, i)) return false;
  }
  if (!joinSubpaths(scene, to) || !target_.weigh(to) || reconnectionVertex(to) != reconnection)
    return false;
  logRatio = logDensity(to, reconnection) - logDensity(from, reconnection);
  if (settings_.hessian) {
    prepare(proposed, reconnection, context);
    const float back[2] = {-offset[0], -offset[1]};
    logRatio += proposed.lens.logDensity(back) - current.lens.logDensity(offset);
  }
  return true;
}

}  // namespace h2mc
