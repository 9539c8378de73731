// SPDX-License-Identifier: MIT
// What the steps of local_form.h are made of.
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

  // `more`: outputs beyond the usual number.
  Step(ad::Composition<S>& composition, const Path& path, const Variable (&inputs)[M], int more = 0)
      : composition_(composition) {
    std::copy_n(inputs, M, inputs_);
    if constexpr (kMoving) inputs_[M] = path.timeCoordinate();
    for (int i = 0; i < kInputs; ++i) x_[i] = D::variable(composition.value(inputs_[i]), i);
    outputs_ = composition.template outputs<kInputs>(kMostOutputs + more);
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
  bool any() const { return count_ > 0; }
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

// Adds the outputs that say where a ray arrives: at vertex `next`, and at those beyond that it goes straight on to.
template <class S, bool kMoving>
template <int M>
auto LocalForm<S, kMoving>::leave(Step<M>& step, const Vec3<typename Step<M>::D>& origin,
                                  const Vec3<typename Step<M>::D>& direction,
                                  typename Step<M>::D vcm, bool fromInfinity, Side side, int next,
                                  DirectionChart<S>& chart) -> Leaving {
  using D = typename Step<M>::D;
  Leaving r;
  D distance;
  const auto meet = [&](int vertex) {
    const TracedVertex& v = vertexOf(side, vertex);
    D length;
    const Vec2<D> at = coordinatesOnPrimitive<D>(scene_.shapes, v.id, v.vertex.point.p, origin,
                                                 direction, length, step.time());
    if (vertex == next) distance = length;
    const int output = step.add(at.x);
    step.add(at.y);
    return output;
  };
  r.at = meet(next);
  const int passed = passedFrom(side, next);
  for (int i = 1; i <= passed; ++i) meet(next + i);
  chart = DirectionChart<S>(value3(direction));
  const Vec2<D> turned = chart.coordinates(direction);
  r.direction = step.add(turned.x);
  step.add(turned.y);
  // Straight on, nothing is left of vcm.
  if (passed == 0 && value(vcm) > 0) {
    if (!fromInfinity) vcm = vcm * distance * distance;
    r.vcm = step.addLog(vcm);
  }
  return r;
}

template <class S, bool kMoving>
template <int M>
void LocalForm<S, kMoving>::arrive(const Step<M>& step, const Leaving& leaving, Subpath& subpath) {
  subpath.at = step.variable(leaving.at);
  subpath.direction = step.variable(leaving.direction);
  subpath.vcm = step.variable(leaving.vcm);
}

// The vertex that inputs `first` .. `first` + 3 describe.
template <class S, bool kMoving>
template <int M>
auto LocalForm<S, kMoving>::arrival(const Step<M>& step, int first, const Subpath& subpath,
                                    const TracedVertex& vertex) const
    -> Arrival<typename Step<M>::D> {
  using D = typename Step<M>::D;
  const Vec3<D> direction = subpath.chart.direction(Vec2<D>(step.x(first + 2), step.x(first + 3)));
  return Arrival<D>(direction, [&] {
    SurfacePoint<D> point =
        pointOnPrimitive<D>(scene_.shapes, vertex.id, vertex.vertex.point.p,
                            Vec2<D>(step.x(first), step.x(first + 1)), step.time());
    // Exactly where it was traced: coordinates on large surfaces are less precise than points.
    if constexpr (std::is_same_v<S, float>) {
      setValue(point.p, vertex.vertex.point.p);
      setValue(point.uv, vertex.vertex.point.uv);
    }
    if (const FrameMap* map = materialAt(scene_, vertex.id).frame.get()) [[unlikely]]
      mapFrame<D>(*map, scene_.shapes, vertex.id, -direction, point, step.time());
    return point;
  });
}

// Texture coordinates at the vertex that inputs 0 and 1 describe.
template <class S, bool kMoving>
template <int M>
auto LocalForm<S, kMoving>::uvAt(const Step<M>& step, const TracedVertex& vertex) const
    -> Vec2<typename Step<M>::D> {
  using D = typename Step<M>::D;
  Vec2<D> uv = pointOnPrimitive<D>(scene_.shapes, vertex.id, vertex.vertex.point.p,
                                   Vec2<D>(step.x(0), step.x(1)), step.time())
                   .uv;
  if constexpr (std::is_same_v<S, float>) setValue(uv, vertex.vertex.point.uv);
  return uv;
}

// Whether two duals are the same function, as far as they know: to the bit, which is quicker than by value and asks for
// more.
// NOLINTBEGIN(bugprone-suspicious-memory-comparison)
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
// NOLINTEND(bugprone-suspicious-memory-comparison)

// A scattering's vc over the cosine of what it scatters. At a mirror both are one function, of which
// nothing is left: computed, its second derivatives where light grazes would leave their rounding.
template <class D>
D overCosIn(const Scattering<D>& scattering, const Arrival<D>& vertex) {
  if (scattering.delta && same(scattering.vc, vertex.cosIn)) return D(Scalar<D>(1));
  return scattering.vc / vertex.cosIn;
}

// The part of terms that have cancelled that is counted as added up: they are numbers of O(1), with few roundings in
// them.
inline constexpr float kCancelledPart = 1.f / 16;

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

}  // namespace h2mc
