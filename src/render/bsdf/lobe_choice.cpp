#include "render/bsdf/lobe_choice.h"

#include <algorithm>

namespace h2mc {
namespace {

int lobeCount(const Bsdf& bsdf) {
  return std::visit([](const auto& b) { return std::remove_cvref_t<decltype(b)>::kLobes; }, bsdf);
}

// The first choice in (0, 1) for which `later` holds; it is false at 0, true at 1 and monotone.
template <class Predicate>
float firstChoice(Predicate&& later) {
  float low = 0, high = 1;
  while (true) {
    const float middle = 0.5f * (low + high);
    if (middle <= low || middle >= high || high - low < 0x1p-30f) return high;
    (later(middle) ? high : low) = middle;
  }
}

}  // namespace

ChoiceInterval choiceInterval(std::span<const Bsdf> bsdfs, const Material& material,
                              const Vec2f& uv, const Vec3f& wi, float u0, float u1, LobeId lobe) {
  const auto at = [&](float choice) {
    return chooseLobe(bsdfs, material, uv, wi, u0, u1, choice);
  };
  // At most three intervals: a BSDF's two lobes, and passing through where it is not opaque.
  const LobeId first = at(0), last = at(0x1.fffffep-1f);
  if (first == last) return lobe == first ? ChoiceInterval{0, 1} : ChoiceInterval{};
  const float begin = lobe == first  ? 0
                      : lobe == last ? firstChoice([&](float c) { return at(c) == last; })
                                     : firstChoice([&](float c) { return !(at(c) == first); });
  const float end = lobe == last    ? 1
                    : lobe == first ? firstChoice([&](float c) { return !(at(c) == first); })
                                    : firstChoice([&](float c) { return at(c) == last; });
  return begin < end && at(begin) == lobe ? ChoiceInterval{begin, end} : ChoiceInterval{};
}

bool drawLobe(std::span<const Bsdf> bsdfs, const Material& material, const Vec2f& uv,
              const Vec3f& wi, const Vec3f& wo, float u, LobeId& lobe) {
  bool back;
  const Bsdf* const bsdf = detail::seen(bsdfs, material, wi.z, back);
  if (!bsdf) return false;
  const float total = evaluateMaterial<float>(bsdfs, material, uv, wi, wo).pdf;
  if (!(total > 0)) return false;
  u *= total;
  LobeId candidate{0, back, false};
  bool found = false;
  for (int i = 0; i < lobeCount(*bsdf); ++i) {
    candidate.lobe = static_cast<std::uint8_t>(i);
    const float pdf = lobePdf<float>(bsdfs, material, uv, wi, wo, candidate);
    if (!(pdf > 0)) continue;
    lobe = candidate;
    found = true;
    if ((u -= pdf) < 0) break;
  }
  return found;
}

float widestLobe(std::span<const Bsdf> bsdfs, const Material& material, LobeId lobe) {
  const Bsdf* const bsdf = lobe.null ? nullptr : detail::ofLobe(bsdfs, material, lobe);
  float widest = 0;
  for (int i = 0; bsdf && i < lobeCount(*bsdf); ++i) {
    lobe.lobe = static_cast<std::uint8_t>(i);
    if (!isDelta(bsdfs, material, lobe))
      widest = std::max(widest, lobeWidth(bsdfs, material, lobe));
  }
  return widest;
}

}  // namespace h2mc
