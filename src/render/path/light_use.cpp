// SPDX-License-Identifier: MIT
#include "render/path/light_use.h"

#include <algorithm>
#include <cmath>

#include "render/core/index.h"
#include "render/core/random.h"
#include "render/path/connect.h"
#include "render/path/path.h"

namespace h2mc {
namespace {

constexpr std::uint64_t kStream = 0x6c69676874;
constexpr int kVertices = 3;             // of a camera path
constexpr int kGrid = 24;                // paths along each side of the film, at most
constexpr double kShadowRays = 100'000;  // at most, about
constexpr int kSamplesOfFew = 16;        // a vertex, shared out among the lights: at least one each
constexpr double kPowerInDirect = 0.1, kPowerInEmission = 0.5;

// Luminance that `light` sends on to the camera by way of a vertex, an estimate from one sample; no
// probability of choosing the light in it.
double arriving(const Scene& scene, const TracedVertex& v, int light, float time, Random& random) {
  const PrimitiveId primitive = pickPrimitive(scene, light, random.uniform());
  const float u0 = random.uniform(), u1 = random.uniform();
  DirectLight<float> direct;
  const Link<float> link = linkToLight<float>(scene, v.vertex, v.id, light, primitive, u0, u1,
                                              Techniques::kUnidirectional, direct, &time);
  const double value = luminance(link.value) * scene.directPicker.probability(light);
  if (!(value > 0) || !std::isfinite(value)) return 0;
  return lightVisible(scene, v.vertex.point, light, direct, time) ? value : 0;
}

// Adds the squares of the lights' shares at a vertex, times its weight.
void addShares(const Scene& scene, const TracedVertex& v, float time, Random& random,
               std::vector<double>& values, std::vector<double>& squares) {
  const int samples = std::max(1, kSamplesOfFew / static_cast<int>(values.size()));
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 0;
    if (!(scene.directPicker.probability(static_cast<int>(i)) > 0)) continue;
    for (int k = 0; k < samples; ++k)
      values[i] += arriving(scene, v, static_cast<int>(i), time, random);
    sum += values[i];
  }
  if (!(sum > 0)) return;
  const double weight = std::min(1.0, double(luminance(v.vertex.throughput)));
  for (std::size_t i = 0; i < values.size(); ++i) squares[i] += weight * squared(values[i] / sum);
}

// Of `uses` and, with its share, what `powers` has; both probabilities.
LightPicker mixture(const std::vector<double>& uses, const LightPicker& powers, double share) {
  std::vector<double> weights;
  for (std::size_t i = 0; i < uses.size(); ++i)
    weights.push_back((1 - share) * uses[i] +
                      share * double(powers.probability(static_cast<int>(i))));
  return LightPicker(weights);
}

}  // namespace

void pickLightsByUse(Scene& scene) {
  const std::size_t lights = scene.lights.size();
  std::vector<double> values(lights), squares(lights, 0);
  const double perPath = kVertices * std::max<double>(kSamplesOfFew, static_cast<double>(lights));
  const int grid = std::clamp(static_cast<int>(std::sqrt(kShadowRays / perPath)), 1, kGrid);
  Path path(kVertices + 1);
  path.technique = {0, kVertices + 1};
  for (int cell = 0; cell < grid * grid; ++cell) {
    Random random(0, kStream, static_cast<std::uint64_t>(cell));
    for (float& u : path.sample.u) u = random.uniform();
    for (float& choice : path.sample.choice) choice = random.uniform();
    const int column = cell % grid, row = cell / grid;
    const auto size = static_cast<float>(grid);
    path.sample.u[0] = (static_cast<float>(column) + random.uniform()) / size;
    path.sample.u[1] = (static_cast<float>(row) + random.uniform()) / size;
    drawShared(scene.shared(), random, path.sample);
    for (int i = 1; i <= kVertices && stepCamera(scene, path, i) == Step::kArrived; ++i) {
      const TracedVertex& v = path.camera[at(i)];
      if (hasNonDelta(scene.bsdfs, materialAt(scene, v.id)))
        addShares(scene, v, path.sample.time, random, values, squares);
    }
  }
  double sum = 0;
  for (double& s : squares) sum += s = std::sqrt(s);
  if (!(sum > 0)) return;
  for (double& s : squares) s /= sum;
  scene.directPicker = mixture(squares, scene.directPicker, kPowerInDirect);
  scene.emissionPicker = mixture(squares, scene.emissionPicker, kPowerInEmission);
}

}  // namespace h2mc
