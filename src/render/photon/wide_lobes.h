// SPDX-License-Identifier: MIT
// Which part of a surface's scattering photons are gathered for: its wide lobes. Narrow ones need photons from few
// directions, which are rare; the camera's path follows them as it follows a mirror.
#pragma once

#include <vector>

#include "render/bsdf/material.h"

namespace h2mc {

// Splits what a material scatters, f, between its lobes by their shares of the density: f = f_wide + f_narrow, where
// f_wide = f * (density of wide lobes) / (density of all). Drawn through a narrow lobe, and over the density of all, a
// direction is then a sample of f_narrow as it stands.
class WideLobes {
 public:
  // Lobes are wide from this width on, in radians; a diffuse lobe has pi / 2, a mirror's 0. Keeps a reference to the
  // BSDFs. Precondition: narrowest > 0.
  WideLobes(std::span<const Bsdf> bsdfs, std::span<const Material> materials, float narrowest);

  // Whether the material, number `material`, has any.
  bool in(int material) const { return kinds_[at(material)].wide; }
  bool isWide(const Material& material, LobeId lobe) const {
    return !isDelta(bsdfs_, material, lobe) && lobeWidth(bsdfs_, material, lobe) >= narrowest_;
  }
  // f_wide / f of material number `index`, which is `material`.
  float share(int index, const Material& material, const Vec2f& uv, const Vec3f& wi,
              const Vec3f& wo) const {
    return kinds_[at(index)].narrow ? split(material, uv, wi, wo).share() : 1;
  }

 private:
  struct Kinds {
    bool wide = false, narrow = false;  // not counting mirrors
  };
  struct Densities {
    float wide = 0, all = 0;
    float share() const { return all > 0 ? std::min(1.f, wide / all) : 0; }
  };
  Kinds kindsOf(const Material& material) const;
  Densities split(const Material& material, const Vec2f& uv, const Vec3f& wi,
                  const Vec3f& wo) const;

  std::span<const Bsdf> bsdfs_;
  float narrowest_;
  std::vector<Kinds> kinds_;  // by material
};

}  // namespace h2mc
