// SPDX-License-Identifier: MIT
// The steps of local_form.h; instantiated once for each scalar (local_form_*.cpp).
#pragma once

#include "render/path/local_form_step.h"

namespace h2mc {

template <class S, bool kMoving>
template <bool kAperture>
auto LocalForm<S, kMoving>::fromFilm(int more) {
  if constexpr (kAperture) {
    const int a = path_.apertureCoordinate();
    return Step<4>(composition_, path_, {0, 1, a, a + 1}, more);
  } else {
    return Step<2>(composition_, path_, {0, 1}, more);
  }
}

template <class S, bool kMoving>
template <bool kAperture>
void LocalForm<S, kMoving>::startCamera() {
  auto step = fromFilm<kAperture>(2 * passedFrom(Side::kCamera, 1));
  using D = typename decltype(step)::D;
  const PathRay<D> ray = h2mc::startCamera<D>(scene_, step.x(0), step.x(1), step.time(),
                                              kAperture ? &step.x(2) : nullptr);
  const Leaving leaving = leave(step, ray.origin, ray.direction, ray.vcm, ray.fromInfinity,
                                Side::kCamera, 1, camera_.chart);
  step.apply();
  arrive(step, leaving, camera_);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::startLight() {
  const int u = path_.technique.lightOffset();
  Step<4> step(composition_, path_, {u, u + 1, u + 2, u + 3}, 2 * passedFrom(Side::kLight, 1));
  using D = typename Step<4>::D;
  const PathRay<D> ray =
      h2mc::startLight<D>(scene_, path_.lightIndex, path_.lightPrimitive, step.x(0), step.x(1),
                          step.x(2), step.x(3), step.time());
  const Leaving leaving = leave(step, ray.origin, ray.direction, ray.vcm, ray.fromInfinity,
                                Side::kLight, 1, light_.chart);
  int throughput[3];
  logFactor(step, ray.throughput, throughput);
  const int vc = step.addLog(ray.vc);
  step.apply();
  arrive(step, leaving, light_);
  multiply(step, throughput);
  light_.vc = step.variable(vc);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::scatter(Side side, int index) {
  const bool camera = side == Side::kCamera;
  Subpath& subpath = camera ? camera_ : light_;
  const TracedVertex& here = vertexOf(side, index);
  const int u =
      camera ? path_.technique.cameraCoordinate(index) : path_.technique.lightCoordinate(index);
  Step<6> step(composition_, path_,
               {subpath.at, subpath.at + 1, subpath.direction, subpath.direction + 1, u, u + 1},
               2 * passedFrom(side, index + 1));
  using D = typename Step<6>::D;
  const Arrival<D> vertex = arrival(step, 0, subpath, here);
  const Scattering<D> s =
      scatteringFrom<D>(scene_, vertex, here.id, here.lobe, step.x(4), step.x(5), side);
  const Leaving leaving =
      leave(step, vertex.point.p, s.direction, s.vcm, false, side, index + 1, subpath.chart);
  int throughput[3];
  logFactor(step, s.factor, throughput);
  // What is zero by now stays so: its logarithm is not needed.
  const bool hasVc = subpath.vc != kNone;
  const int factor = hasVc || !s.delta ? step.addLog(overCosIn(s, vertex)) : kNone;
  const int reverse = hasVc && !s.delta ? step.addLog(s.reverse) : kNone;
  step.apply();
  // After a vertex that was gone straight through, vc is alone in the root: of the cosine in `reverse` and the one that
  // `factor` is divided by, nothing is left where scattering is diffuse.
  if (std::is_same_v<S, float> && reverse != kNone && index > 1 &&
      vertexOf(side, index - 1).lobe.null) {
    const S scale = S(kCancelledPart) / squared(value(vertex.cosIn));
    for (int i = 0; i < 2; ++i) {
      composition_.cancelled(subpath.direction + i, scale);
      if (!vertex.point.constantNormal) composition_.cancelled(subpath.at + i, scale);
    }
  }
  if (const Variable scale = step.variable(factor); scale == kNone)
    subpath.vc = kNone;
  else if (!s.delta)
    subpath.vc = logRoot(subpath, step.variable(reverse), scale);
  else if (hasVc)
    subpath.vc = composition_.sum(subpath.vc, scale);
  arrive(step, leaving, subpath);
  multiply(step, throughput);
}

// The ray stays what it is, and the vertices beyond have been met by it already: nothing depends on this vertex but
// the share that passes, which knows its texture coordinates alone.
template <class S, bool kMoving>
void LocalForm<S, kMoving>::passThrough(Side side, int index) {
  Subpath& subpath = side == Side::kCamera ? camera_ : light_;
  const TracedVertex& here = vertexOf(side, index);
  Step<2> step(composition_, path_, {subpath.at, subpath.at + 1});
  using D = typename Step<2>::D;
  int throughput[3];
  logFactor(step, passingShare<D>(materialAt(scene_, here.id), uvAt(step, here)), throughput);
  if (step.any()) step.apply();
  multiply(step, throughput);
  subpath.at += 2;
  subpath.vcm = kNone;
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::passToEnvironment() {
  const TracedVertex& here = cameraVertex(path_.technique.t - 2);
  Step<4> step(composition_, path_,
               {camera_.at, camera_.at + 1, camera_.direction, camera_.direction + 1});
  using D = typename Step<4>::D;
  const Vec3<D> direction = camera_.chart.direction(Vec2<D>(step.x(2), step.x(3)));
  const Link<D> link = linkOfEnvironment<D>(scene_, direction, path_.technique.t, kBoth);
  int out[3], vc = kNone;
  logFactor(step, passingShare<D>(materialAt(scene_, here.id), uvAt(step, here)) * link.value, out);
  if (value(link.camera.vc) > 0) vc = step.addLog(link.camera.vc);
  step.apply();
  multiply(step, out);
  addTerm(step, vc, camera_.vc);
}

template <class S, bool kMoving>
template <bool kAperture>
void LocalForm<S, kMoving>::seeEnvironment() {
  auto step = fromFilm<kAperture>();
  using D = typename decltype(step)::D;
  const PathRay<D> ray = h2mc::startCamera<D>(scene_, step.x(0), step.x(1), step.time(),
                                              kAperture ? &step.x(2) : nullptr);
  end(step, linkOfEnvironment<D>(scene_, ray.direction, path_.technique.t, kBoth), nullptr,
      nullptr);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::scatterToEnvironment() {
  const int index = path_.technique.t - 2;
  const TracedVertex& here = cameraVertex(index);
  const int u = path_.technique.cameraCoordinate(index);
  Step<6> step(composition_, path_,
               {camera_.at, camera_.at + 1, camera_.direction, camera_.direction + 1, u, u + 1});
  using D = typename Step<6>::D;
  const Arrival<D> vertex = arrival(step, 0, camera_, here);
  const Scattering<D> s =
      scatteringFrom<D>(scene_, vertex, here.id, here.lobe, step.x(4), step.x(5), Side::kCamera);
  const Link<D> link = linkOfEnvironment<D>(scene_, s.direction, path_.technique.t, kBoth);
  int out[3], vcm = kNone, vc = kNone, reverse = kNone;
  logFactor(step, s.factor * link.value, out);
  if (value(link.camera.vcm) > 0 && !s.delta) vcm = step.addLog(s.vcm * link.camera.vcm);
  if (value(link.camera.vc) > 0) {
    vc = step.addLog(overCosIn(s, vertex) * link.camera.vc);
    if (camera_.vc != kNone && !s.delta) reverse = step.addLog(s.reverse);
  }
  step.apply();
  multiply(step, out);
  if (vcm != kNone) terms_[termCount_++] = step.variable(vcm);
  addTerm(step, vc, s.delta ? camera_.vc : logRoot(camera_, step.variable(reverse)));
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::hitLight() {
  const TracedVertex& here = cameraVertex(path_.technique.t - 1);
  Step<4> step(composition_, path_,
               {camera_.at, camera_.at + 1, camera_.direction, camera_.direction + 1});
  using D = typename Step<4>::D;
  const Arrival<D> vertex = arrival(step, 0, camera_, here);
  const Vec3<D> direction = camera_.chart.direction(Vec2<D>(step.x(2), step.x(3)));
  end(step,
      linkOfAreaLight<D>(scene_, vertex.point, direction, path_.lightIndex, path_.technique.t,
                         kBoth, here.id, step.time()),
      &vertex.cosIn, nullptr);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::connectToLight() {
  const TracedVertex& here = cameraVertex(path_.technique.t - 1);
  const int u = path_.technique.lightOffset();
  Step<6> step(composition_, path_,
               {camera_.at, camera_.at + 1, camera_.direction, camera_.direction + 1, u, u + 1});
  using D = typename Step<6>::D;
  const Arrival<D> vertex = arrival(step, 0, camera_, here);
  DirectLight<D> direct;
  end(step,
      linkToLight<D>(scene_, vertex, here.id, path_.lightIndex, path_.lightPrimitive, step.x(4),
                     step.x(5), kBoth, direct, step.time()),
      &vertex.cosIn, nullptr);
}

// Between two points of one sphere, cosines and length go together: the geometry factor is the same for all chords.
// Its rounding remains, and is magnified the more, the faster the ends move and the more they bend on their way.
template <class S, bool kMoving>
void LocalForm<S, kMoving>::countCancelledChord(const TracedVertex& cameraEnd,
                                                const TracedVertex& lightEnd) {
  const Geometry& geometry = scene_.shapes[cameraEnd.id.shape].geometry;
  if (cameraEnd.id.shape != lightEnd.id.shape ||
      !(std::holds_alternative<Sphere>(geometry) || std::holds_alternative<MovingSphere>(geometry)))
    return;
  const Vec3f chord = lightEnd.vertex.point.p - cameraEnd.vertex.point.p;
  const S cosine2 = squared(S(dot(cameraEnd.vertex.point.ng, chord))) / S(dot(chord, chord));
  // First and, squared, second derivatives of log cosine and log length, in radii.
  const S change = S(0.5) / cosine2;
  const auto count = [&](const Subpath& subpath, const TracedVertex& end) {
    const S bend = S(1) / S(std::abs(end.vertex.wi.z));
    for (int i = 0; i < 2; ++i)
      composition_.cancelled(subpath.at + i, kCancelledPart * change * (change + bend));
  };
  count(camera_, cameraEnd);
  count(light_, lightEnd);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::connectVertices() {
  const TracedVertex& cameraEnd = cameraVertex(path_.technique.t - 1);
  const TracedVertex& lightEnd = lightVertex(path_.technique.s - 1);
  Step<8> step(composition_, path_,
               {camera_.at, camera_.at + 1, camera_.direction, camera_.direction + 1, light_.at,
                light_.at + 1, light_.direction, light_.direction + 1});
  using D = typename Step<8>::D;
  const Arrival<D> camera = arrival(step, 0, camera_, cameraEnd);
  const Arrival<D> light = arrival(step, 4, light_, lightEnd);
  end(step, linkOfVertices<D>(scene_, camera, cameraEnd.id, light, lightEnd.id), &camera.cosIn,
      &light.cosIn);
  if constexpr (std::is_same_v<S, float>) countCancelledChord(cameraEnd, lightEnd);
}

template <class S, bool kMoving>
template <bool kAperture>
void LocalForm<S, kMoving>::connectToCamera() {
  const TracedVertex& here = lightVertex(path_.technique.s - 1);
  const auto connect = [&](auto&& step, const auto* aperture) {
    using D = typename std::remove_cvref_t<decltype(step)>::D;
    const Arrival<D> vertex = arrival(step, 0, light_, here);
    end(step, linkToCamera<D>(scene_, vertex, here.id, step.time(), aperture), nullptr,
        &vertex.cosIn);
  };
  const Variable at = light_.at, direction = light_.direction;
  if constexpr (kAperture) {
    const int a = path_.apertureCoordinate();
    Step<6> step(composition_, path_, {at, at + 1, direction, direction + 1, a, a + 1});
    connect(step, &step.x(4));
  } else {
    connect(Step<4>(composition_, path_, {at, at + 1, direction, direction + 1}),
            static_cast<const typename Step<4>::D*>(nullptr));
  }
}

// log(luminance of the channels) + log(1 / (1 + sum of terms^2)). Channels of the same factors are one.
template <class S, bool kMoving>
auto LocalForm<S, kMoving>::finish() -> Variable {
  Variable sums[3];
  int count = 0;
  bool taken[3] = {false, false, false};
  for (int c = 0; c < 3; ++c) {
    const Channel& channel = channels_[c];
    if (channel.dark || taken[c]) continue;
    double weight = kLuminance[c] * channel.scale;
    for (int d = c + 1; d < 3; ++d) {
      if (channels_[d].dark || taken[d] ||
          !std::equal(channel.logs, channel.logs + channel.count, channels_[d].logs,
                      channels_[d].logs + channels_[d].count))
        continue;
      taken[d] = true;
      weight += kLuminance[d] * channels_[d].scale;
    }
    typename ad::Composition<S>::Term factors[kMaxPathLength + 3];
    for (int i = 0; i < channel.count; ++i) factors[i] = {channel.logs[i], S(1)};
    factors[channel.count] = {composition_.constant(static_cast<S>(std::log(weight))), S(1)};
    sums[count++] = composition_.linear(factors, channel.count + 1);
  }
  if (count == 0) return kNone;
  const Variable value = composition_.logSumExp(sums, count, S(1));
  if (termCount_ == 0) return value;
  terms_[termCount_++] = composition_.constant(S(0));
  return composition_.linear(
      {{value, S(1)}, {composition_.logSumExp(terms_, termCount_, S(2)), S(-2)}});
}

template <class S, bool kMoving>
auto LocalForm<S, kMoving>::logTarget(const S* u) -> Variable {
  composition_.begin(u, path_.dimension());
  const auto [s, t] = path_.technique;
  const int arrivals = lastVertex(Side::kCamera);
  const bool aperture = path_.aperture;
  if (arrivals >= 1) aperture ? startCamera<true>() : startCamera<false>();
  const auto goOn = [&](Side side, int i) {
    vertexOf(side, i).lobe.null ? passThrough(side, i) : scatter(side, i);
  };
  for (int i = 1; i < arrivals; ++i) goOn(Side::kCamera, i);
  if (s >= 2) {
    startLight();
    for (int i = 1; i < s - 1; ++i) goOn(Side::kLight, i);
  }
  if (path_.escaped && arrivals == 0)
    aperture ? seeEnvironment<true>() : seeEnvironment<false>();
  else if (path_.escaped)
    cameraVertex(arrivals).lobe.null ? passToEnvironment() : scatterToEnvironment();
  else if (s == 0)
    hitLight();
  else if (s == 1)
    connectToLight();
  else if (t == 1)
    aperture ? connectToCamera<true>() : connectToCamera<false>();
  else
    connectVertices();
  return finish();
}

}  // namespace h2mc
