// SPDX-License-Identifier: MIT
#include "render/path/reconnect.h"

#include <cmath>

#include "render/bsdf/lobe_choice.h"
#include "render/core/index.h"

namespace h2mc {
namespace {

std::vector<TracedVertex>& subpath(Path& path, Side side) {
  return side == Side::kCamera ? path.camera : path.light;
}
std::size_t coordinateOf(const Technique& technique, Side side, int i) {
  return at(side == Side::kCamera ? technique.cameraCoordinate(i) : technique.lightCoordinate(i));
}
std::size_t choiceOf(const Technique& technique, Side side, int i) {
  return at(side == Side::kCamera ? technique.cameraChoice(i) : technique.lightChoice(i));
}

// Draws the choice coordinate of the sample's lobe; false if none chooses it.
bool drawChoice(const Scene& scene, PrimitiveId id, const Vec2f& uv, const Vec3f& wi,
                Random& random, ScatterSample& sample) {
  const ChoiceInterval choice = choiceInterval(scene.bsdfs, materialAt(scene, id), uv, wi,
                                               sample.u.x, sample.u.y, sample.lobe);
  if (!(choice.end > choice.begin)) return false;
  sample.choice = std::min(choice.begin + (choice.end - choice.begin) * random.uniform(),
                           std::nextafter(choice.end, 0.f));
  return true;
}

void setScattering(Path& path, Side side, int i, const ScatterSample& sample) {
  subpath(path, side)[at(i)].lobe = sample.lobe;
  const std::size_t k = coordinateOf(path.technique, side, i);
  path.sample.u[k] = sample.u.x;
  path.sample.u[k + 1] = sample.u.y;
  path.sample.choice[choiceOf(path.technique, side, i)] = sample.choice;
}

}  // namespace

bool invertScattering(const Scene& scene, PrimitiveId id, const Vec2f& uv, const Vec3f& wi,
                      const Vec3f& wo, Random& random, ScatterSample& sample) {
  const Material& material = materialAt(scene, id);
  return drawLobe(scene.bsdfs, material, uv, wi, wo, random.uniform(), sample.lobe) &&
         invertLobe(scene.bsdfs, material, uv, wi, wo, sample.lobe, sample.u) &&
         drawChoice(scene, id, uv, wi, random, sample);
}

bool invertDelta(const Scene& scene, PrimitiveId id, const Vec2f& uv, const Vec3f& wi, LobeId lobe,
                 Random& random, ScatterSample& sample) {
  sample.lobe = lobe;
  sample.u.x = random.uniform();
  sample.u.y = random.uniform();
  return drawChoice(scene, id, uv, wi, random, sample);
}

bool aim(const Scene& scene, Path& path, Side side, int i, const Vec3f& direction, Random& random) {
  const TracedVertex& v = subpath(path, side)[at(i)];
  const SurfacePoint<float>& point = v.vertex.point;
  ScatterSample sample;
  if (!invertScattering(scene, v.id, point.uv, v.vertex.wi, point.shading.toLocal(direction),
                        random, sample))
    return false;
  setScattering(path, side, i, sample);
  return true;
}

bool aimDelta(const Scene& scene, Path& path, Side side, int i, LobeId lobe, Random& random) {
  const TracedVertex& v = subpath(path, side)[at(i)];
  ScatterSample sample;
  if (!invertDelta(scene, v.id, v.vertex.point.uv, v.vertex.wi, lobe, random, sample)) return false;
  setScattering(path, side, i, sample);
  return true;
}

bool follow(const Scene& scene, Path& path, Side side, int i, PrimitiveId next) {
  std::vector<TracedVertex>& vertices = subpath(path, side);
  const TracedVertex& v = vertices[at(i)];
  const std::size_t k = coordinateOf(path.technique, side, i);
  const PathRay<float> ray = scatterFrom<float>(scene, v.vertex, v.id, v.lobe, path.sample.u[k],
                                                path.sample.u[k + 1], side);
  if (dark(ray.throughput)) return false;
  if (side == Side::kCamera) {
    path.lastRay = ray;
    if (!next.valid()) {
      path.escaped = true;
      return true;
    }
  }
  TracedVertex& arrived = vertices[at(i) + 1];
  arrived.id = next;
  arrived.vertex = arriveAt<float>(scene, ray, next, &path.sample.time);
  return true;
}

double logLobeDensity(const Scene& scene, const Path& path) {
  double sum = 0;
  const auto add = [&](const TracedVertex& v, const Vec3f& direction, Side side, int i) {
    const Material& material = materialAt(scene, v.id);
    const Vec2f& uv = v.vertex.point.uv;
    const Vec3f& wi = v.vertex.wi;
    const float* u = path.sample.u.data() + coordinateOf(path.technique, side, i);
    const ChoiceInterval choice = choiceInterval(scene.bsdfs, material, uv, wi, u[0], u[1], v.lobe);
    sum -= std::log(double(choice.end) - choice.begin);
    if (isDelta(scene.bsdfs, material, v.lobe)) return;
    const Vec3f wo = v.vertex.point.shading.toLocal(direction);
    const double share = lobePdf<float>(scene.bsdfs, material, uv, wi, wo, v.lobe);
    sum += std::log(share / evaluateMaterial<float>(scene.bsdfs, material, uv, wi, wo).pdf);
  };
  const auto arrivedAlong = [](const TracedVertex& v) {
    return -v.vertex.point.shading.toWorld(v.vertex.wi);
  };
  const auto [s, t] = path.technique;
  for (int i = 1; i <= t - 2; ++i)
    add(path.camera[at(i)],
        path.escaped && i == t - 2 ? path.lastRay.direction : arrivedAlong(path.camera[at(i) + 1]),
        Side::kCamera, i);
  for (int i = 1; i <= s - 2; ++i)
    add(path.light[at(i)], arrivedAlong(path.light[at(i) + 1]), Side::kLight, i);
  return sum;
}

}  // namespace h2mc
