// SPDX-License-Identifier: MIT
#include "render/bsdf/coat.h"

#include "render/bsdf/bsdf.h"

namespace h2mc {
namespace {

template <class B>
int cosineLobeOf(const B& bsdf) {
  if constexpr (std::is_same_v<B, FurtherBsdf>)
    return std::visit([](const auto& b) { return cosineLobeOf(b); }, bsdf.bsdf);
  else if constexpr (std::is_base_of_v<CosineLobe, B>)
    return 0;
  else if constexpr (requires { B::kDiffuse; })
    return B::kDiffuse;
  else
    return -1;
}

}  // namespace

CoatedBsdf::CoatedBsdf(Bsdf below)
    : bsdf(std::move(below)),
      lobes(std::visit([](const auto& b) { return lobesOf(b); }, bsdf)),
      cosineLobe(std::visit([](const auto& b) { return cosineLobeOf(b); }, bsdf)) {}

template <class Interface>
int Coat<Interface>::lobes() const {
  return kFirstBelow + below->lobes;
}

template <class Interface>
bool Coat<Interface>::isDelta(int lobe) const {
  if (lobe == kSpecular) return !Interface::kRough;
  return lobe < lobes() &&
         std::visit([&](const auto& b) { return b.isDelta(lobe - kFirstBelow); }, below->bsdf);
}

template <class Interface>
bool Coat<Interface>::hasNonDelta() const {
  return Interface::kRough ||
         std::visit([](const auto& b) { return b.hasNonDelta(); }, below->bsdf);
}

template <class Interface>
float Coat<Interface>::belowShare(const Vec3f& wi, Vec3f& inside) const {
  return wi.z > 0 && refractIn(wi, inside) ? std::min(belowProbability(wi.z), 1.f) : 0;
}

template <class Interface>
int Coat<Interface>::chooseLobe(const Vec2f& uv, const Vec3f& wi, float u0, float u1,
                                float choice) const {
  Vec3f in;
  const float share = belowShare(wi, in);
  if (choice >= share) return kSpecular;
  const float rest = toUnitInterval(double(choice) / share);
  return kFirstBelow +
         std::visit([&](const auto& b) { return b.chooseLobe(uv, in, u0, u1, rest); }, below->bsdf);
}

template <class Interface>
ChoiceInterval Coat<Interface>::choiceInterval(const Vec2f& uv, const Vec3f& wi, float u0, float u1,
                                               int lobe) const {
  Vec3f in;
  const float share = belowShare(wi, in);
  if (lobe == kSpecular) return {share, 1};
  if (!(share > 0)) return {};
  const ChoiceInterval inner = std::visit(
      [&](const auto& b) { return choiceIntervalOf(b, uv, in, u0, u1, lobe - kFirstBelow); },
      below->bsdf);
  return {inner.begin * share, inner.end * share};
}

template <class Interface>
bool Coat<Interface>::invert(const Vec2f& uv, const Vec3f& wi, const Vec3f& wo, int lobe,
                             Vec2f& u) const {
  if (!(wi.z > 0 && wo.z > 0) || lobe >= lobes()) return false;
  if (drawnOutside(lobe)) return invertCosine(wo, u);
  if (lobe == kSpecular) {
    if constexpr (Interface::kRough) {
      const Vec3<double> in(wi);
      return interface.facets.invert(in, in + Vec3<double>(wo), u);
    }
    return false;
  }
  Vec3f in, out;
  if (!(refractIn(wi, in) && refractIn(wo, out))) return false;
  return std::visit([&](const auto& b) { return b.invert(uv, in, out, lobe - kFirstBelow, u); },
                    below->bsdf);
}

template <class Interface>
float Coat<Interface>::width(int lobe) const {
  if (lobe == kSpecular) {
    if constexpr (Interface::kRough) return interface.facets.width();
    return 0;
  }
  // Angles grow by eta on the way out.
  const float inner =
      std::visit([&](const auto& b) { return b.width(lobe - kFirstBelow); }, below->bsdf);
  return std::min(kPi / 2, inner * std::max(1.f, interface.eta));
}

template <class Interface>
Rgbf Coat<Interface>::albedo() const {
  const Rgbf base = std::visit([](const auto& b) { return b.albedo(); }, below->bsdf);
  return absorbed<float>(base * 0.9f, Vec2f(0.5f), 1, 1) +
         average(*specular) * (0.05f * specularScale);
}

template struct Coat<SmoothInterface>;
template struct Coat<RoughInterface>;

}  // namespace h2mc
