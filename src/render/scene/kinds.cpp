#include "render/scene/kinds.h"

#include <iterator>

namespace h2mc {
namespace {

// In the order of the variants' alternatives.
constexpr const char* kShapes[] = {"triangle mesh",        "sphere",        "disk",
                                   "moving triangle mesh", "moving sphere", "moving disk"};
constexpr const char* kLights[] = {"area", "point", "spot", "directional", "constant", "envmap"};
constexpr const char* kBsdfs[] = {"diffuse",   "phong",      "roughconductor", "roughdielectric",
                                  "conductor", "dielectric", "plastic",        "roughplastic"};

static_assert(std::size(kShapes) == std::variant_size_v<decltype(Shape::geometry)>);
static_assert(std::size(kLights) == std::variant_size_v<Light>);
static_assert(std::size(kBsdfs) == std::variant_size_v<Bsdf>);

}  // namespace

const char* kindOf(const Shape& shape) { return kShapes[shape.geometry.index()]; }
const char* kindOf(const Light& light) { return kLights[light.index()]; }
const char* kindOf(const Bsdf& bsdf) { return kBsdfs[bsdf.index()]; }
std::span<const char* const> lightKinds() { return kLights; }
std::span<const char* const> bsdfKinds() { return kBsdfs; }

}  // namespace h2mc
