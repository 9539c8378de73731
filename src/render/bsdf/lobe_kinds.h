// SPDX-License-Identifier: MIT
// Members that BSDFs of one kind have in common (bsdf.h says what each is).
#pragma once

#include <algorithm>

#include "render/bsdf/bsdf_types.h"
#include "render/core/hemisphere.h"

namespace h2mc {

// All lobes are like mirrors.
struct DeltaLobes {
  bool isDelta(int) const { return true; }
  bool hasNonDelta() const { return false; }
  template <class T>
  BsdfValue<T> evaluate(const Vec2<T>&, const Vec3<T>&, const Vec3<T>&) const {
    return BsdfValue<T>::zero();
  }
  template <class T>
  Vec3<T> sample(const Vec2<T>&, const Vec3<T>&, int, const T&, const T&) const {
    return noDirection<T>();
  }
  template <class T>
  T lobePdf(const Vec2<T>&, const Vec3<T>&, const Vec3<T>&, int) const {
    return T(0);
  }
  bool invert(const Vec2f&, const Vec3f&, const Vec3f&, int, Vec2f&) const { return false; }
  float width(int) const { return 0; }
};

// None is.
struct NonDeltaLobes {
  bool isDelta(int) const { return false; }
  bool hasNonDelta() const { return true; }
  template <class T>
  DeltaSample<T> sampleDelta(const Vec2<T>&, const Vec3<T>&, int) const {
    return DeltaSample<T>::none();
  }
};

// A single lobe, drawn in proportion to the cosine.
struct CosineLobe : NonDeltaLobes {
  static constexpr int kLobes = 1;
  bool transmits() const { return false; }
  float lobeSplit(const Vec2f&, const Vec3f&, float, float) const { return 1; }
  int chooseLobe(const Vec2f&, const Vec3f&, float, float, float) const { return 0; }
  template <class T>
  Vec3<T> sample(const Vec2<T>&, const Vec3<T>&, int, const T& u0, const T& u1) const {
    return sampleCosine(u0, u1);
  }
  template <class T>
  T lobePdf(const Vec2<T>&, const Vec3<T>& wi, const Vec3<T>& wo, int) const {
    return value(wi.z) > 0 && value(wo.z) > 0 ? T(wo.z * kInvPiOf<T>) : T(0);
  }
  bool invert(const Vec2f&, const Vec3f& wi, const Vec3f& wo, int, Vec2f& u) const {
    return wi.z > 0 && invertCosine(wo, u);
  }
  float width(int) const { return kPi / 2; }
};

// How many lobes there are: kLobes but where that is only the most there may be.
template <class B>
int lobesOf(const B& bsdf) {
  if constexpr (requires { bsdf.lobes(); })
    return bsdf.lobes();
  else
    return B::kLobes;
}

// Which choices draw a lobe that there is: by choiceInterval(), or by the lobeSplit() of those with two lobes at most.
template <class B>
ChoiceInterval choiceIntervalOf(const B& bsdf, const Vec2f& uv, const Vec3f& wi, float u0, float u1,
                                int lobe) {
  if constexpr (requires { bsdf.choiceInterval(uv, wi, u0, u1, lobe); }) {
    return bsdf.choiceInterval(uv, wi, u0, u1, lobe);
  } else {
    const float split = std::clamp(bsdf.lobeSplit(uv, wi, u0, u1), 0.f, 1.f);
    const bool first = split > 0 && bsdf.chooseLobe(uv, wi, u0, u1, 0) == lobe;
    return first ? ChoiceInterval{0, split} : ChoiceInterval{split, 1};
  }
}

}  // namespace h2mc
