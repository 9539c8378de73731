// SPDX-License-Identifier: MIT
// BSDFs: how a surface scatters light, in the shading frame (z = the shading normal).
//
// Directions point away from the surface. `wi` is the direction towards the camera side of the path
// and `wo` the one towards the light, so that value() is one function of the path whatever end it
// was traced from: a light subpath calls evaluate(toCamera, toLight) all the same and reads its own
// sampling density from `pdfReverse`.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <variant>

#include "render/bsdf/bsdf_types.h"
#include "render/bsdf/conductor.h"
#include "render/bsdf/dielectric.h"
#include "render/bsdf/diffuse.h"
#include "render/bsdf/further_bsdf.h"
#include "render/bsdf/phong.h"
#include "render/bsdf/plastic.h"
#include "render/bsdf/rough_conductor.h"
#include "render/bsdf/rough_dielectric.h"
#include "render/bsdf/rough_plastic.h"
#include "render/scene/plugin.h"

namespace h2mc {

// What each alternative provides (B = the struct, all const):
//
//   static constexpr int kLobes;             // number of lobes, indexed 0 .. kLobes - 1
//   int lobes();                             // optional: how many of these there are
//   bool isDelta(int lobe);                  // a mirror-like lobe
//   bool hasNonDelta();                      // evaluate() can be non-zero: connections are worth it
//   bool transmits();                        // can scatter to the other side
//
//   // f(wi, wo) |cos(wo)| of all non-delta lobes together (radiance flowing from wo to wi, with the
//   // factor (eta_i/eta_o)^2 of refraction), and the solid-angle densities with which sampling
//   // draws wo given wi (pdf) and wi given wo (pdfReverse), lobe probabilities included.
//   // Zero where there is no scattering; finite for all unit vectors.
//   template <class T> BsdfValue<T> evaluate(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo);
//
//   // Optional: what evaluate() says of a wo that was drawn for wi, in closed form; see SampledBsdf.
//   template <class T> SampledBsdf<T> sampled(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo);
//
//   // The lobe drawn for wi with the choice coordinate in [0, 1); (u0, u1) are the direction's
//   // coordinates, which some lobes' probabilities depend on (roughdielectric's facet).
//   int chooseLobe(const Vec2f& uv, const Vec3f& wi, float u0, float u1, float choice);
//   // Below this choice it is the lobe that chooseLobe gives at 0, from there on the other one.
//   float lobeSplit(const Vec2f& uv, const Vec3f& wi, float u0, float u1);
//   // Instead of that, where there may be more than two: the choices that draw the lobe.
//   ChoiceInterval choiceInterval(const Vec2f& uv, const Vec3f& wi, float u0, float u1, int lobe);
//
//   // The direction that the non-delta lobe draws from (u0, u1) in [0, 1)^2. u1 is an azimuth: it
//   // wraps. May return a direction that evaluate() gives zero for: noDirection() where the draw
//   // means nothing, such as a facet seen from behind.
//   template <class T> Vec3<T> sample(const Vec2<T>& uv, const Vec3<T>& wi, int lobe, const T& u0,
//                                     const T& u1);
//
//   // Density of drawing wo through this lobe: its share of evaluate().pdf, the probability of the
//   // lobe included. Zero for delta lobes.
//   template <class T> T lobePdf(const Vec2<T>& uv, const Vec3<T>& wi, const Vec3<T>& wo, int lobe);
//
//   // (u0, u1) with sample(..., u0, u1) == wo; false when the lobe cannot draw wo.
//   bool invert(const Vec2f& uv, const Vec3f& wi, const Vec3f& wo, int lobe, Vec2f& u);
//
//   // Delta lobes: the direction, the coefficient of radiance transport from wo to wi (Fresnel
//   // reflectance, or transmittance with (eta_i/eta_o)^2; no cosine) over the probability that
//   // chooseLobe picks the lobe, the same for importance (without the eta factor), and that
//   // probability. DeltaSample::none() where the lobe scatters nothing.
//   template <class T> DeltaSample<T> sampleDelta(const Vec2<T>& uv, const Vec3<T>& wi, int lobe);
//
//   // A number that orders BSDFs by how concentrated they are: the lobe's width in radians
//   // (diffuse: pi/2, delta: 0). For lobe `lobe`.
//   float width(int lobe);
//   Rgbf albedo();                           // rough estimate, for statistics and `h2mc info`
using Bsdf = std::variant<Diffuse, Phong, RoughConductor, RoughDielectric, Conductor, Dielectric,
                          Plastic, RoughPlastic, FurtherBsdf>;

// What is under a coat: reflects only, and is no coat.
struct CoatedBsdf {
  explicit CoatedBsdf(Bsdf below);
  Bsdf bsdf;
  int lobes;
  int cosineLobe;  // the one that sampleCosine() draws, whatever the direction; -1: none
};

struct Material;

// Two materials by shares: scale ((1 - w) first + w second), w in [0, 1] by texture. More than two are a
// chain of these. Neither has an opacity or a frame map.
struct Blend {
  std::shared_ptr<const Material> first, second;
  TexturePtr weight;
  float scale = 1;

  template <class T>
  T weightAt(const Vec2<T>& uv) const {
    return ad::clamp(scalarOf(evaluate<T>(*weight, uv)), Scalar<T>(0), Scalar<T>(1));
  }
};

// How the shading frame follows from the surface's (render/path/frame_map.h).
struct FrameMap {
  enum class Kind : std::uint8_t {
    kTangent,  // along dp/du, for what is not the same in all directions
    kBump,     // by a height, in the world's units, along the normal
    kNormal    // by a normal, 2 rgb - 1, in the frame of normal and dp/du
  };
  Kind kind = Kind::kTangent;
  TexturePtr texture;    // of kBump and kNormal
  bool perSide = false;  // seen from behind, heights point to where they are seen from as well
};

// A surface's material: one BSDF a side, and an opacity. `twosided` is front == back.
struct Material {
  std::string name;    // id or plugin name, for messages
  std::string plugin;  // as the scene named it
  int front = -1;      // index into Scene::bsdfs; -1 scatters nothing
  int back = -1;       // for wi.z < 0; -1: no twosided, the front BSDF sees wi.z < 0 itself
  bool twosided = false;
  TexturePtr opacity;  // null: opaque. Otherwise the share of light that meets the BSDF
  std::shared_ptr<const Blend> blend;     // if there is one, front, back and twosided say nothing
  std::shared_ptr<const FrameMap> frame;  // null: the surface's own
};

// Every BSDF a scene file can name. twosided, mask, blends and maps, which make no BSDF of their own,
// are read by the scene reader, their tables are here too.
struct BsdfPlugin {
  std::string_view name, description;
  std::span<const Parameter> parameters;
  Bsdf (*create)(const Properties&);  // null for what makes no BSDF of its own
  int nestedBsdfs = 0;
  Bsdf (*coat)(const Properties&,
               const Bsdf& below) = nullptr;  // of those that make one of another
};
std::span<const BsdfPlugin> bsdfPlugins();

}  // namespace h2mc

#include "render/bsdf/coat_inl.h"  // needs Bsdf
