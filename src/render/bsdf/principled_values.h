// SPDX-License-Identifier: MIT
// The parameters of the principled BSDF, and what follows from them.
#pragma once

#include <memory>

#include "render/bsdf/anisotropic_facets.h"
#include "render/bsdf/clearcoat.h"
#include "render/texture/texture.h"

namespace h2mc {

// The parameters at a point: numbers from 0 to 1, and a colour that is not negative. P: a plain number, or the
// derivative type where one of them comes from a texture.
template <class P>
struct PrincipledValues {
  Vec3<P> color;
  P roughness, anisotropic, metallic, specTrans, specTint, sheen, sheenTint, flatness, clearcoat,
      clearcoatGloss;

  PrincipledValues() = default;
  // number(i): the i-th in their order.
  template <class Number>
  PrincipledValues(const Vec3<P>& baseColor, Number&& number)
      : color(baseColor),
        roughness(number(0)),
        anisotropic(number(1)),
        metallic(number(2)),
        specTrans(number(3)),
        specTint(number(4)),
        sheen(number(5)),
        sheenTint(number(6)),
        flatness(number(7)),
        clearcoat(number(8)),
        clearcoatGloss(number(9)) {}
  template <class Q>
  explicit PrincipledValues(const PrincipledValues<Q>& v)
      : color(v.color),
        roughness(v.roughness),
        anisotropic(v.anisotropic),
        metallic(v.metallic),
        specTrans(v.specTrans),
        specTint(v.specTint),
        sheen(v.sheen),
        sheenTint(v.sheenTint),
        flatness(v.flatness),
        clearcoat(v.clearcoat),
        clearcoatGloss(v.clearcoatGloss) {}

  // Shares of what refracts, and of the diffuse base.
  P refracting() const { return (S(1) - metallic) * specTrans; }
  P base() const { return (S(1) - metallic) * (S(1) - specTrans); }
  // [Burley 2012, section 5.4]
  AnisotropicFacets<P> facets() const {
    const P aspect = ad::sqrt(P(S(1) - anisotropic * S(0.9))), alpha = roughness * roughness;
    return {ad::max(P(alpha / aspect), S(kSmallest)), ad::max(P(alpha * aspect), S(kSmallest))};
  }
  ClearcoatFacets<P> coat() const { return {clearcoatGloss * S(0.001 - 0.1) + S(0.1)}; }
  // The colour at luminance 1; white where it is black.
  Vec3<P> tint() const {
    const P y = luminance(color);
    if (!(value(y) > S(1e-8))) return Vec3<P>(P(S(1)), P(S(1)), P(S(1)));
    return color * P(S(1) / y);
  }

  // Probabilities of the lobes outside: facets (with what they refract), coat, diffuse base and sheen.
  struct Shares {
    P facets, coat, diffuse;
  };
  Shares shares() const {
    const P coat = clearcoat * S(0.25), diffuse = base() + sheen * (S(1) - metallic) * S(0.25);
    const P facets = S(1) / P(coat + diffuse + S(1));
    return {facets, coat * facets, diffuse * facets};
  }

 private:
  using S = Scalar<P>;
  static constexpr float kSmallest = 1e-3f;
};

// A surface with such parameters, any of which may be a texture's.
struct PrincipledSurface {
  static constexpr int kNumbers = 10;
  PrincipledValues<float> means;  // the values themselves where none has a texture
  // Of all parameters, in the order of PrincipledValues; null where none has a texture.
  struct Textures {
    TexturePtr color, numbers[kNumbers];
  };
  std::shared_ptr<const Textures> textures;

  // f(PrincipledValues) at uv.
  template <class T, class F>
  auto withValues(const Vec2<T>& uv, F&& f) const {
    using S = Scalar<T>;
    if (!textures) [[likely]] {
      if constexpr (std::is_same_v<S, float>)
        return f(means);
      else
        return f(PrincipledValues<S>(means));
    }
    return withTextures<T>(uv, std::forward<F>(f));
  }

 private:
  template <class T, class F>
  [[gnu::noinline]] auto withTextures(const Vec2<T>& uv, F&& f) const {
    using S = Scalar<T>;
    return f(PrincipledValues<T>(h2mc::evaluate<T>(*textures->color, uv), [&](int i) {
      const T x = scalarOf(h2mc::evaluate<T>(*textures->numbers[i], uv));
      return T(ad::clamp(x, S(0), S(1)));
    }));
  }
};

}  // namespace h2mc
