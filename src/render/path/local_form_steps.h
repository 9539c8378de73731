// The steps of local_form.h; instantiated once for each scalar (local_form_*.cpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/path/local_form.h"

namespace h2mc {

template <class S, bool kMoving>
template <int M>
class LocalForm<S, kMoving>::Step {
 public:
  static constexpr int kInputs = M + kTime;
  using D = ad::Dual2<S, kInputs>;

  Step(ad::Composition<S>& composition, const Path& path, const Variable (&inputs)[M])
      : composition_(composition) {
    std::copy_n(inputs, M, inputs_);
    if constexpr (kMoving) inputs_[M] = path.technique.dimension();
    for (int i = 0; i < kInputs; ++i) x_[i] = D::variable(composition.value(inputs_[i]), i);
    outputs_ = composition.template outputs<kInputs>(kMostOutputs);
  }

  const D& x(int i) const { return x_[i]; }
  const D* time() const { return kMoving ? &x_[kInputs - 1] : nullptr; }

  int add(const D& output) {
    outputs_[count_] = output;
    return count_++;
  }
  int addLog(const D& output) { return value(output) > 0 ? add(log(output)) : kNone; }
  // Once all outputs are there: makes variables of them.
  void apply() { first_ = composition_.apply(inputs_, count_); }
  Variable variable(int output) const { return output == kNone ? kNone : first_ + output; }

 private:
  ad::Composition<S>& composition_;
  Variable inputs_[kInputs];
  D x_[kInputs];
  static constexpr int kMostOutputs = 12;
  D* outputs_;
  int count_ = 0;
  Variable first_ = kNone;
};

// Adds the outputs that say where a ray arrives.
template <class S, bool kMoving>
template <int M>
auto LocalForm<S, kMoving>::leave(Step<M>& step, const Vec3<typename Step<M>::D>& origin,
                                  const Vec3<typename Step<M>::D>& direction,
                                  typename Step<M>::D vcm, bool fromInfinity,
                                  const TracedVertex& next, DirectionChart<S>& chart) -> Leaving {
  using D = typename Step<M>::D;
  D distance;
  const Vec2<D> at = coordinatesOnPrimitive<D>(scene_.shapes, next.id, next.vertex.point.p, origin,
                                               direction, distance, step.time());
  chart = DirectionChart<S>(value3(direction));
  const Vec2<D> turned = chart.coordinates(direction);
  Leaving r;
  r.at[0] = step.add(at.x);
  r.at[1] = step.add(at.y);
  r.direction[0] = step.add(turned.x);
  r.direction[1] = step.add(turned.y);
  if (value(vcm) > 0) {
    if (!fromInfinity) vcm = vcm * distance * distance;
    r.vcm = step.addLog(vcm);
  }
  return r;
}

template <class S, bool kMoving>
template <int M>
void LocalForm<S, kMoving>::arrive(const Step<M>& step, const Leaving& leaving, Subpath& subpath) {
  for (int i = 0; i < 2; ++i) {
    subpath.at[i] = step.variable(leaving.at[i]);
    subpath.direction[i] = step.variable(leaving.direction[i]);
  }
  subpath.vcm = step.variable(leaving.vcm);
}

// The vertex that inputs `first` .. `first` + 3 describe.
template <class S, bool kMoving>
template <int M>
auto LocalForm<S, kMoving>::arrival(const Step<M>& step, int first, const Subpath& subpath,
                                    const TracedVertex& vertex) const
    -> Arrival<typename Step<M>::D> {
  using D = typename Step<M>::D;
  Arrival<D> arrival(subpath.chart.direction(Vec2<D>(step.x(first + 2), step.x(first + 3))), [&] {
    return pointOnPrimitive<D>(scene_.shapes, vertex.id, vertex.vertex.point.p,
                               Vec2<D>(step.x(first), step.x(first + 1)), step.time());
  });
  // Exactly where it was traced: coordinates on large surfaces are less precise than points.
  if constexpr (std::is_same_v<S, float>) {
    setValue(arrival.point.p, vertex.vertex.point.p);
    setValue(arrival.point.uv, vertex.vertex.point.uv);
  }
  return arrival;
}

// Whether two duals are the same function, as far as they know.
template <class D>
bool same(const D& a, const D& b) {
  return a.v == b.v && std::memcmp(a.g, b.g, sizeof a.g) == 0 &&
         std::memcmp(a.h, b.h, sizeof a.h) == 0;
}

template <class D>
bool isConstant(const D& a) {
  constexpr D zero{};
  return std::memcmp(a.g, zero.g, sizeof a.g) == 0 && std::memcmp(a.h, zero.h, sizeof a.h) == 0;
}

// A scattering's vc over the cosine of what it scatters. At a mirror both are one function, of which
// nothing is left: computed, its second derivatives where light grazes would leave their rounding.
template <class D>
D overCosIn(const Scattering<D>& scattering, const Arrival<D>& vertex) {
  if (scattering.delta && same(scattering.vc, vertex.cosIn)) return D(Scalar<D>(1));
  return scattering.vc / vertex.cosIn;
}

// Channels with the same factor share an output; a constant needs none.
template <class S, bool kMoving>
template <int M>
void LocalForm<S, kMoving>::logFactor(Step<M>& step, const Rgb<typename Step<M>::D>& factor,
                                      int (&outputs)[3]) {
  for (int c = 0; c < 3; ++c) {
    outputs[c] = kNone;
    if (channels_[c].dark) continue;
    if (isConstant(factor[c])) {
      channels_[c].scale *= static_cast<double>(value(factor[c]));
      channels_[c].dark = !(value(factor[c]) > 0);
      continue;
    }
    if (c > 0 && outputs[c - 1] != kNone && same(factor[c], factor[c - 1]))
      outputs[c] = outputs[c - 1];
    else
      outputs[c] = step.addLog(factor[c]);
    channels_[c].dark = outputs[c] == kNone;
  }
}

template <class S, bool kMoving>
template <int M>
void LocalForm<S, kMoving>::multiply(const Step<M>& step, const int (&outputs)[3]) {
  for (int c = 0; c < 3; ++c)
    if (Channel& channel = channels_[c]; !channel.dark && outputs[c] != kNone)
      channel.logs[channel.count++] = step.variable(outputs[c]);
}

template <class S, bool kMoving>
template <int M>
auto LocalForm<S, kMoving>::logFactors(Step<M>& step,
                                       const typename Link<typename Step<M>::D>::Factors& factors,
                                       const typename Step<M>::D& cosIn) -> Factors {
  Factors r;
  if (value(factors.vcm) > 0) r.vcm = step.addLog(factors.vcm / cosIn);
  if (value(factors.vc) > 0) r.vc = step.addLog(factors.vc / cosIn);
  return r;
}

template <class S, bool kMoving>
template <int M>
void LocalForm<S, kMoving>::addTerm(const Step<M>& step, int output, Variable log) {
  if (output != kNone && log != kNone)
    terms_[termCount_++] = composition_.sum(step.variable(output), log);
}

// A technique's last step: its outputs, and the terms of the MIS weight. The subpaths that have a vertex
// there give its cosIn.
template <class S, bool kMoving>
template <int M>
void LocalForm<S, kMoving>::end(Step<M>& step, const Link<typename Step<M>::D>& link,
                                const typename Step<M>::D* cameraCosIn,
                                const typename Step<M>::D* lightCosIn) {
  int value[3];
  logFactor(step, link.value, value);
  const int direct = step.addLog(link.direct);
  Factors camera, light;
  if (cameraCosIn) camera = logFactors(step, link.camera, *cameraCosIn);
  if (lightCosIn) light = logFactors(step, link.light, *lightCosIn);
  step.apply();
  multiply(step, value);
  if (direct != kNone) terms_[termCount_++] = step.variable(direct);
  addTerm(step, camera.vcm, camera_.vcm);
  addTerm(step, camera.vc, camera_.vc);
  addTerm(step, light.vcm, light_.vcm);
  addTerm(step, light.vc, light_.vc);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::startCamera() {
  Step<2> step(composition_, path_, {0, 1});
  using D = typename Step<2>::D;
  const PathRay<D> ray = h2mc::startCamera<D>(scene_, step.x(0), step.x(1), step.time());
  const Leaving leaving = leave(step, ray.origin, ray.direction, ray.vcm, ray.fromInfinity,
                                cameraVertex(1), camera_.chart);
  step.apply();
  arrive(step, leaving, camera_);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::startLight() {
  const int u = path_.technique.lightOffset();
  Step<4> step(composition_, path_, {u, u + 1, u + 2, u + 3});
  using D = typename Step<4>::D;
  const PathRay<D> ray =
      h2mc::startLight<D>(scene_, path_.lightIndex, path_.lightPrimitive, step.x(0), step.x(1),
                          step.x(2), step.x(3), step.time());
  const Leaving leaving = leave(step, ray.origin, ray.direction, ray.vcm, ray.fromInfinity,
                                lightVertex(1), light_.chart);
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
  const TracedVertex& here = camera ? cameraVertex(index) : lightVertex(index);
  const TracedVertex& next = camera ? cameraVertex(index + 1) : lightVertex(index + 1);
  const int u =
      camera ? path_.technique.cameraCoordinate(index) : path_.technique.lightCoordinate(index);
  Step<6> step(
      composition_, path_,
      {subpath.at[0], subpath.at[1], subpath.direction[0], subpath.direction[1], u, u + 1});
  using D = typename Step<6>::D;
  const Arrival<D> vertex = arrival(step, 0, subpath, here);
  const Scattering<D> s =
      scatteringFrom<D>(scene_, vertex, here.id, here.lobe, step.x(4), step.x(5), side);
  const Leaving leaving =
      leave(step, vertex.point.p, s.direction, s.vcm, false, next, subpath.chart);
  int throughput[3];
  logFactor(step, s.factor, throughput);
  // What is zero by now stays so: its logarithm is not needed.
  const bool hasVc = subpath.vc != kNone;
  const int factor = hasVc || !s.delta ? step.addLog(overCosIn(s, vertex)) : kNone;
  const int reverse = hasVc && !s.delta ? step.addLog(s.reverse) : kNone;
  step.apply();
  if (const Variable scale = step.variable(factor); scale == kNone)
    subpath.vc = kNone;
  else if (!s.delta)
    subpath.vc = logRoot(subpath, step.variable(reverse), scale);
  else if (hasVc)
    subpath.vc = composition_.sum(subpath.vc, scale);
  arrive(step, leaving, subpath);
  multiply(step, throughput);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::seeEnvironment() {
  Step<2> step(composition_, path_, {0, 1});
  using D = typename Step<2>::D;
  const PathRay<D> ray = h2mc::startCamera<D>(scene_, step.x(0), step.x(1), step.time());
  end(step, linkOfEnvironment<D>(scene_, ray.direction, path_.technique.t, kBoth), nullptr,
      nullptr);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::scatterToEnvironment() {
  const int index = path_.technique.t - 2;
  const TracedVertex& here = cameraVertex(index);
  const int u = path_.technique.cameraCoordinate(index);
  Step<6> step(
      composition_, path_,
      {camera_.at[0], camera_.at[1], camera_.direction[0], camera_.direction[1], u, u + 1});
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
               {camera_.at[0], camera_.at[1], camera_.direction[0], camera_.direction[1]});
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
  Step<6> step(
      composition_, path_,
      {camera_.at[0], camera_.at[1], camera_.direction[0], camera_.direction[1], u, u + 1});
  using D = typename Step<6>::D;
  const Arrival<D> vertex = arrival(step, 0, camera_, here);
  DirectLight<D> direct;
  end(step,
      linkToLight<D>(scene_, vertex, here.id, path_.lightIndex, path_.lightPrimitive, step.x(4),
                     step.x(5), kBoth, direct, step.time()),
      &vertex.cosIn, nullptr);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::connectVertices() {
  const TracedVertex& cameraEnd = cameraVertex(path_.technique.t - 1);
  const TracedVertex& lightEnd = lightVertex(path_.technique.s - 1);
  Step<8> step(composition_, path_,
               {camera_.at[0], camera_.at[1], camera_.direction[0], camera_.direction[1],
                light_.at[0], light_.at[1], light_.direction[0], light_.direction[1]});
  using D = typename Step<8>::D;
  const Arrival<D> camera = arrival(step, 0, camera_, cameraEnd);
  const Arrival<D> light = arrival(step, 4, light_, lightEnd);
  end(step, linkOfVertices<D>(scene_, camera, cameraEnd.id, light, lightEnd.id), &camera.cosIn,
      &light.cosIn);
}

template <class S, bool kMoving>
void LocalForm<S, kMoving>::connectToCamera() {
  const TracedVertex& here = lightVertex(path_.technique.s - 1);
  Step<4> step(composition_, path_,
               {light_.at[0], light_.at[1], light_.direction[0], light_.direction[1]});
  using D = typename Step<4>::D;
  const Arrival<D> vertex = arrival(step, 0, light_, here);
  end(step, linkToCamera<D>(scene_, vertex, here.id, step.time()), nullptr, &vertex.cosIn);
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
  const int arrivals = path_.escaped ? t - 2 : t - 1;
  if (arrivals >= 1) startCamera();
  for (int i = 1; i < arrivals; ++i) scatter(Side::kCamera, i);
  if (s >= 2) {
    startLight();
    for (int i = 1; i < s - 1; ++i) scatter(Side::kLight, i);
  }
  if (path_.escaped)
    arrivals >= 1 ? scatterToEnvironment() : seeEnvironment();
  else if (s == 0)
    hitLight();
  else if (s == 1)
    connectToLight();
  else if (t == 1)
    connectToCamera();
  else
    connectVertices();
  return finish();
}

}  // namespace h2mc
