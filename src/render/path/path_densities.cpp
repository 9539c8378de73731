// SPDX-License-Identifier: MIT
#include "render/path/path_densities.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/core/index.h"

namespace h2mc {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

double logOf(double x) { return x > 0 ? std::log(x) : kNever; }

// The edge from x_i to x_(i-1).
struct Edge {
  Vec3f toLight;
  double
      inverse2;  // 1 / length^2; 1 to an infinite light or a parallel camera: no density's business
  double cosCamera,
      cosLight;  // |cos| with the geometric normal at x_i and at x_(i-1); 1 without a surface
};

Edge edgeAt(const Scene& scene, const FullPath& path, int i) {
  Edge e;
  float distance;
  e.toLight = directionToLight(path, i, distance);
  e.inverse2 = std::isinf(distance) ? 1 : 1 / squared(double(distance));
  const auto cosine = [&](const FullVertex& v) {
    return v.id.valid() ? std::abs(double(v.point.cosine(e.toLight))) : 1.0;
  };
  e.cosCamera = cosine(path.x[at(i)]);
  e.cosLight = cosine(path.x[at(i) - 1]);
  // The eye has no surface, but a direction of view, which its density per solid angle depends on.
  if (i == path.edges) e.cosCamera = dot(scene.camera.forwardOf(path.time), e.toLight);
  return e;
}

// What the path's end on the light says.
struct LightEnd {
  Rgbf emitted{0};      // radiance (intensity, irradiance) towards x_1
  double direct = 0;    // density of x_0 as a direct sample: per area, per solid angle, or 1
  double emission = 0;  // of x_0 and the direction to x_1
  bool canBeHit = true;
};

LightEnd lightEnd(const Scene& scene, const FullPath& path, const Edge& edge) {
  return std::visit(
      [&](const auto& l) {
        LightEnd end;
        const LightContext context = scene.lightContext();
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(l)>, CollimatedLight>) {
          end.canBeHit = false;
          if (!l.reaches(path.x[1].point.p)) return end;
          end.emitted = l.flux;
          end.emission = 1;
          return end;
        }
        if (l.isDelta()) {
          // Its sample is the same for all coordinates.
          const auto r = l.template sampleDirect<float>(context, {}, path.x[1].point.p, 0.5f, 0.5f);
          // What arrives of a point's intensity has the distance in it, as the edge does.
          end.emitted = r.arriving * static_cast<float>(1 / edge.inverse2);
          end.direct = r.directPdf > 0 ? 1 : 0;
          end.emission = r.emissionPdf;
          end.canBeHit = false;
          return end;
        }
        LightHit<float> hit;
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(l)>, AreaLight>)
          hit = l.template hit<float>(context, path.x[0].point, edge.toLight, path.x[0].id,
                                      &path.time);
        else
          hit = l.template hit<float>(context, path.x[0].point, edge.toLight);
        end.emitted = hit.radiance;
        end.direct = hit.directPdf;
        end.emission = hit.emissionPdf;
        return end;
      },
      scene.lights[at(path.light)]);
}

// Scattering at x_i.
struct Bounce {
  Rgbf value{0};       // f(camera, light) |cos| of light that arrives along the next edge
  double toLight = 0;  // densities per solid angle, of the next direction given the other one
  double toCamera = 0;
  double logTurn = 0;  // delta: log of solid angle towards the camera over that towards the light
};

Bounce bounceAt(const Scene& scene, const FullVertex& v, const Vec3f& toCamera,
                const Vec3f& toLight) {
  const Material& material = materialAt(scene, v.id);
  const Vec3f wi = v.point.shading.toLocal(toCamera), wo = v.point.shading.toLocal(toLight);
  Bounce b;
  if (v.point.bendBlocks(toLight, toCamera)) return b;
  if (!v.delta) {
    const BsdfValue<float> e = evaluateMaterial<float>(scene.bsdfs, material, v.point.uv, wi, wo);
    b.value = e.value;
    b.toLight = e.pdf;
    b.toCamera = e.pdfReverse;
    return b;
  }
  const DeltaSample<float> d = sampleDelta<float>(scene.bsdfs, material, v.point.uv, wi, v.lobe);
  b.toLight = b.toCamera = d.probability;
  b.value = d.radiance * d.probability;
  // Light that is refracted keeps flux, so that radiance and importance differ by what the cone of
  // directions changes: the ratio of the squared indices and of the cosines to the normal refracted about.
  const double radiance = luminance(d.radiance), importance = luminance(d.importance);
  if (radiance > 0 && importance > 0)
    b.logTurn = std::log(radiance * std::abs(double(wi.z)) / (importance * std::abs(double(wo.z))));
  return b;
}

// f as a product that may leave double's range.
class Product {
 public:
  explicit Product(TechniqueDensities& result) : result_(result) {}
  void times(const Rgbf& value, double factor) {
    result_.color = result_.color * Rgb<double>(value) * factor;
    const double largest = std::max({result_.color.x, result_.color.y, result_.color.z});
    if (largest > 1e-100 && largest < 1e100) return;
    if (!(largest > 0 && std::isfinite(largest))) return;
    result_.color = result_.color * (1 / largest);
    result_.logScale += std::log(largest);
  }

 private:
  TechniqueDensities& result_;
};

void setWeights(TechniqueDensities& r) {
  const double largest =
      *std::max_element(r.logDensity.begin(), r.logDensity.begin() + r.edges + 1);
  double sum = 0;
  for (int s = 0; s <= r.edges; ++s) {
    double& weight = r.weight[at(s)];
    weight = largest > kNever ? std::exp(2 * (r.logDensity[at(s)] - largest)) : 0;
    sum += weight;
  }
  if (sum > 0)
    for (int s = 0; s <= r.edges; ++s) r.weight[at(s)] /= sum;
}

}  // namespace

Rgbf TechniqueDensities::contribution(int s) const {
  if (!(logDensity[at(s)] > kNever)) return Rgbf(0);
  return Rgbf(color * (std::exp(logScale - logDensity[at(s)]) * weight[at(s)]));
}
double TechniqueDensities::target(int s) const { return luminance(contribution(s)); }
double TechniqueDensities::logUnweighted(int s) const {
  return logScale + logOf(luminance(color)) - logDensity[at(s)];
}

double logSpread(const Scene& scene, const FullPath& path, int i, Side side) {
  const Edge edge = edgeAt(scene, path, i);
  return logOf((side == Side::kCamera ? edge.cosLight : edge.cosCamera) * edge.inverse2);
}

TechniqueDensities densities(const Scene& scene, const FullPath& path) {
  const int k = path.edges;
  TechniqueDensities r;
  r.edges = k;
  r.color = Rgb<double>(1);
  Product f(r);

  // From the eye to the light. back[i]: what turns the solid angle at x_(i-1) into the area of x_i; turn: the logTurns
  // of delta vertices.
  std::array<double, kMaxPathLength + 1>& fromCamera = r.fromCamera;
  std::array<double, kMaxPathLength + 1> toCamera, back, turn;
  fromCamera[at(k)] = 0;
  Edge edge = edgeAt(scene, path, k);
  double next =
      edge.cosCamera > 0 ? double(scene.camera.pdf(static_cast<float>(edge.cosCamera))) : 0;
  f.times(Rgbf(1), next);
  for (int i = k - 1; i >= 0; --i) {
    // `edge` is that from x_(i+1) to x_i, `next` the density of its direction.
    const double spread = edge.cosLight * edge.inverse2;
    fromCamera[at(i)] = fromCamera[at(i) + 1] + logOf(next * spread);
    f.times(Rgbf(1), spread);
    if (i == 0) break;
    const Vec3f direction = -edge.toLight;
    edge = edgeAt(scene, path, i);
    const Bounce bounce = bounceAt(scene, path.x[at(i)], direction, edge.toLight);
    f.times(bounce.value, 1);
    next = bounce.toLight;
    toCamera[at(i)] = bounce.toCamera;
    turn[at(i)] = bounce.logTurn;
    back[at(i)] = edge.cosCamera * edge.inverse2;
  }

  // From the light, which `edge` leads to now. Delta lights have no area: the edge's cosine there is 1.
  const LightEnd end = lightEnd(scene, path, edge);
  f.times(end.emitted, 1);
  std::array<double, kMaxPathLength + 1>& p = r.logDensity;
  std::fill_n(p.begin(), k + 1, kNever);
  const auto joinable = [&](int i) { return !path.x[at(i)].delta; };
  const double directPick = scene.directPicker.probability(path.light);
  const double emissionPick = scene.emissionPicker.probability(path.light);
  std::array<double, kMaxPathLength + 1>& fromLight = r.fromLight;
  fromLight[0] = 0;
  fromLight[1] = logOf(directPick * end.direct);
  if (end.canBeHit) p[0] = fromCamera[0];
  if (k >= 2 && joinable(1)) p[1] = fromLight[1] + fromCamera[1];
  std::array<double, kMaxPathLength + 1> turned;  // logTurns of what is made from the light
  turned[0] = turned[1] = 0;
  for (int s = 2; s <= k; ++s) {
    fromLight[at(s)] = s == 2 ? logOf(emissionPick * end.emission * back[1])
                              : fromLight[at(s) - 1] + logOf(toCamera[at(s) - 2] * back[at(s) - 1]);
    turned[at(s)] = s == 2 ? 0 : turned[at(s) - 1] + turn[at(s) - 2];
    if (joinable(s - 1) && joinable(s)) p[at(s)] = fromLight[at(s)] + fromCamera[at(s)];
  }
  setWeights(r);
  // MIS weights reckon with both ends of a delta vertex alike, so they come first.
  for (int s = 2; s <= k; ++s) {
    p[at(s)] += turned[at(s)];
    fromLight[at(s)] += turned[at(s)];
  }
  return r;
}

}  // namespace h2mc
