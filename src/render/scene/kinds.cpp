// SPDX-License-Identifier: MIT
#include "render/scene/kinds.h"

#include <iterator>

namespace h2mc {
namespace {

// In the order of the variants' alternatives.
constexpr const char* kShapes[] = {
    "triangle mesh",        "sphere",        "disk",        "cylinder",
    "moving triangle mesh", "moving sphere", "moving disk", "moving cylinder",
    "moving instance",      "instance"};
constexpr const char* kLights[] = {"area",   "point", "spot",      "directional", "constant",
                                   "envmap", "sun",   "projector", "collimated"};
// Bsdf's, then those of FurtherBsdf, its last alternative.
constexpr const char* kBsdfs[] = {
    "diffuse",      "phong",   "roughconductor", "roughdielectric", "conductor",
    "dielectric",   "plastic", "roughplastic",   "thindielectric",  "difftrans",
    "roughdiffuse", "ward",    "coating",        "roughcoating",    "principled"};
constexpr std::size_t kFurther = std::variant_size_v<Bsdf> - 1;

static_assert(std::size(kShapes) == std::variant_size_v<decltype(Shape::geometry)>);
static_assert(std::size(kLights) == std::variant_size_v<Light>);
static_assert(std::is_same_v<std::variant_alternative_t<kFurther, Bsdf>, FurtherBsdf>);
static_assert(std::size(kBsdfs) == kFurther + std::variant_size_v<decltype(FurtherBsdf::bsdf)>);

}  // namespace

const char* kindOf(const Shape& shape) { return kShapes[shape.geometry.index()]; }
const char* kindOf(const Light& light) { return kLights[light.index()]; }
const char* kindOf(const Bsdf& bsdf) { return kBsdfs[bsdfKindIndex(bsdf)]; }
int bsdfKindIndex(const Bsdf& bsdf) {
  const auto* further = std::get_if<FurtherBsdf>(&bsdf);
  return static_cast<int>(further ? kFurther + further->bsdf.index() : bsdf.index());
}
std::span<const char* const> lightKinds() { return kLights; }
std::span<const char* const> bsdfKinds() { return kBsdfs; }

}  // namespace h2mc
