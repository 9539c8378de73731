// SPDX-License-Identifier: MIT
// The rarer BSDFs, as one alternative of Bsdf: std::visit makes a switch of eleven alternatives at most, and
// what evaluates BSDFs inline is not to grow for these.
#pragma once

#include <variant>

#include "render/bsdf/coat.h"
#include "render/bsdf/diffuse_transmitter.h"
#include "render/bsdf/principled.h"
#include "render/bsdf/rough_diffuse.h"
#include "render/bsdf/thin_dielectric.h"
#include "render/bsdf/ward.h"

namespace h2mc {

// Every member as bsdf.h lists it.
struct FurtherBsdf {
  static constexpr int kLobes = 5;  // a coat over a Principled
  std::variant<ThinDielectric, DiffuseTransmitter, RoughDiffuse, Ward, SmoothCoat, RoughCoat,
               Principled>
      bsdf;

  int lobes() const {
    return std::visit([](const auto& b) { return lobesOf(b); }, bsdf);
  }
  bool isDelta(int lobe) const {
    return std::visit([&](const auto& b) { return has(b, lobe) && b.isDelta(lobe); }, bsdf);
  }
  bool hasNonDelta() const {
    return std::visit([](const auto& b) { return b.hasNonDelta(); }, bsdf);
  }
  bool transmits() const {
    return std::visit([](const auto& b) { return b.transmits(); }, bsdf);
  }
  template <class T>
  [[gnu::noinline]] BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi,
                                          const Vec3<T>& wo) const {
    return std::visit([&](const auto& b) { return b.template evaluate<T>(uv, wi, wo); }, bsdf);
  }
  template <class T>
  [[gnu::noinline]] SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi,
                                           const Vec3<T>& wo) const {
    return std::visit(
        [&](const auto& b) {
          if constexpr (requires { b.template sampled<T>(uv, wi, wo); })
            return b.template sampled<T>(uv, wi, wo);
          else
            return SampledBsdf<T>::zero();  // the thin pane's lobes are delta
        },
        bsdf);
  }
  ChoiceInterval choiceInterval(const Vec2f& uv, const Vec3f& wi, float u0, float u1,
                                int lobe) const {
    return std::visit([&](const auto& b) { return choiceIntervalOf(b, uv, wi, u0, u1, lobe); },
                      bsdf);
  }
  int chooseLobe(const Vec2f& uv, const Vec3f& wi, float u0, float u1, float choice) const {
    return std::visit([&](const auto& b) { return b.chooseLobe(uv, wi, u0, u1, choice); }, bsdf);
  }
  template <class T>
  [[gnu::noinline]] Vec3<T> sample(const Vec2<T>& uv, const Vec3<T>& wi, int lobe, const T& u0,
                                   const T& u1) const {
    return std::visit([&](const auto& b) { return b.template sample<T>(uv, wi, lobe, u0, u1); },
                      bsdf);
  }
  template <class T>
  [[gnu::noinline]] T lobePdf(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo,
                              int lobe) const {
    return std::visit(
        [&](const auto& b) {
          return has(b, lobe) ? b.template lobePdf<T>(uv, wi, wo, lobe) : T(Scalar<T>(0));
        },
        bsdf);
  }
  bool invert(const Vec2f& uv, const Vec3f& wi, const Vec3f& wo, int lobe, Vec2f& u) const {
    return std::visit([&](const auto& b) { return has(b, lobe) && b.invert(uv, wi, wo, lobe, u); },
                      bsdf);
  }
  template <class T>
  [[gnu::noinline]] DeltaSample<T> sampleDelta(const Vec2<T>& uv, const Vec3<T>& wi,
                                               int lobe) const {
    return std::visit([&](const auto& b) { return b.template sampleDelta<T>(uv, wi, lobe); }, bsdf);
  }
  float width(int lobe) const {
    return std::visit([&](const auto& b) { return b.width(lobe); }, bsdf);
  }
  Rgbf albedo() const {
    return std::visit([](const auto& b) { return b.albedo(); }, bsdf);
  }

 private:
  // Not all have as many lobes as this.
  template <class B>
  static bool has(const B& b, int lobe) {
    return lobe < lobesOf(b);
  }
};

}  // namespace h2mc
