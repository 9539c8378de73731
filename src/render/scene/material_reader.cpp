// SPDX-License-Identifier: MIT
// Materials of a scene file: what the table of BSDFs lists, and what is made of others.
#include <fmt/format.h>

#include <set>

#include "render/bsdf/material.h"
#include "render/core/index.h"
#include "render/scene/change_note.h"
#include "render/scene/element_properties.h"
#include "render/scene/reader_context.h"
#include "render/scene/value_text.h"

namespace h2mc {
namespace {

using MaterialPtr = std::shared_ptr<const Material>;

std::string nameOf(const XmlElement& element) {
  const std::string id = element.attribute("id");
  return id.empty() ? element.attribute("type") : id;
}

bool isBent(const Material& material) {
  return material.frame && material.frame->kind != FrameMap::Kind::kTangent;
}

std::shared_ptr<const FrameMap> alongTangents() {
  static const auto map = std::make_shared<const FrameMap>();
  return map;
}

int depthOf(const Material& material) {
  if (!material.blend) return 0;
  return 1 + std::max(depthOf(*material.blend->first), depthOf(*material.blend->second));
}

// The relative indices by which light that is not in delta lobes goes to the other side.
void collectIndices(std::span<const Bsdf> bsdfs, const Material& material,
                    std::set<float>& indices) {
  if (const Blend* blend = material.blend.get()) {
    collectIndices(bsdfs, *blend->first, indices);
    collectIndices(bsdfs, *blend->second, indices);
  } else if (material.front >= 0) {
    const Bsdf& bsdf = bsdfs[at(material.front)];
    if (const auto* rough = std::get_if<RoughDielectric>(&bsdf)) indices.insert(rough->eta);
    const auto* further = std::get_if<FurtherBsdf>(&bsdf);
    if (!further) return;
    if (std::holds_alternative<DiffuseTransmitter>(further->bsdf)) indices.insert(1);
    const auto* principled = std::get_if<Principled>(&further->bsdf);
    if (principled && principled->refracts) indices.insert(principled->eta);
  }
}

bool isCoat(const Bsdf& bsdf) {
  const auto* further = std::get_if<FurtherBsdf>(&bsdf);
  return further && (std::holds_alternative<SmoothCoat>(further->bsdf) ||
                     std::holds_alternative<RoughCoat>(further->bsdf));
}

// Makes the material of one element that others are inside of.
class NestedReader {
 public:
  NestedReader(ReaderContext& context, const XmlElement& element, const BsdfPlugin& plugin)
      : context_(context),
        element_(element),
        properties_(context, element, {"bsdf", plugin.parameters, plugin.nestedBsdfs, {}, false}) {
    if (properties_.nestedBsdfCount() > 0) return;
    throw sourceError(element.place(), properties_.description() + " without a bsdf inside",
                      plugin.name == "twosided"
                          ? "expected one <bsdf> for both sides, or two: front and back"
                          : "expected <bsdf type=\"...\"> or <ref id=\"...\"/>");
  }

  Material twosided() const;
  Material mask() const;
  Material mapped(FrameMap::Kind kind) const;
  Material coated(const BsdfPlugin& plugin) const;
  Material blend() const;
  Material mixture() const;

 private:
  Material nested(int i) const { return properties_.material(properties_.nestedBsdf(i)); }
  [[noreturn]] void reject(int i, const std::string& expected) const {
    throw sourceError(properties_.nestedElement(i).place(),
                      "bsdf \"" + nested(i).plugin + "\" inside " + properties_.description(),
                      expected);
  }
  Material twosidedOf(const Material& front, const Material& back, int backIndex) const;
  // A part of a blend.
  MaterialPtr part(int i) const;
  Material blendOf(MaterialPtr first, MaterialPtr second, TexturePtr weight, float scale) const;
  Material checked(Material material) const;

  std::span<const Bsdf> bsdfs() const { return context_.scene.bsdfs; }

  ReaderContext& context_;
  const XmlElement& element_;
  ElementProperties properties_;
};

Material NestedReader::twosidedOf(const Material& front, const Material& back,
                                  int backIndex) const {
  Material material;
  if (front.frame || back.frame) {
    if (&front != &back && (isBent(front) || isBent(back)))
      reject(backIndex, "expected one bsdf for both sides where it has a bump or normal map");
    FrameMap map = front.frame ? *front.frame : *back.frame;
    map.perSide = isBent(front);
    material.frame = std::make_shared<const FrameMap>(std::move(map));
  }
  if (front.blend || back.blend) {
    if (&front != &back)
      reject(backIndex, "expected one bsdf for both sides where it is a blend or mixture");
    const Blend& blend = *front.blend;
    Blend both = blend;
    both.first = std::make_shared<const Material>(twosidedOf(*blend.first, *blend.first, 0));
    both.second = std::make_shared<const Material>(twosidedOf(*blend.second, *blend.second, 0));
    material.blend = std::make_shared<const Blend>(std::move(both));
    return material;
  }
  material.twosided = true;
  material.front = front.front;
  material.back = back.front;
  return material;
}

Material NestedReader::twosided() const {
  for (int i = 0; i < properties_.nestedBsdfCount(); ++i) {
    const Material side = nested(i);
    if (side.twosided) reject(i, "expected a bsdf that has one side");
    if (transmits(bsdfs(), side)) reject(i, "expected a bsdf that does not let light through");
  }
  const Material front = nested(0);
  if (properties_.nestedBsdfCount() == 1) return twosidedOf(front, front, 0);
  return twosidedOf(front, nested(1), 1);
}

Material NestedReader::mask() const {
  Material material = nested(0);
  if (material.opacity) reject(0, "expected a bsdf that is not a mask");
  material.opacity = properties_.texture("opacity");
  if (const auto* constant = std::get_if<ConstantTexture>(material.opacity.get())) {
    const Rgbf c = constant->color;
    if (c.x >= 1 && c.y >= 1 && c.z >= 1) material.opacity = nullptr;
  }
  return material;
}

Material NestedReader::mapped(FrameMap::Kind kind) const {
  Material material = nested(0);
  if (isBent(material)) reject(0, "expected a bsdf without a bump or normal map");
  FrameMap map;
  map.kind = kind;
  map.texture = properties_.texture("texture");
  if (kind == FrameMap::Kind::kBump && properties_.number("scale") != 1) {
    const float scale = properties_.number("scale");
    map.texture =
        std::make_shared<const Texture>(ProductTexture{constantTexture(Rgbf(scale)), map.texture});
  }
  material.frame = std::make_shared<const FrameMap>(std::move(map));
  return material;
}

Material NestedReader::coated(const BsdfPlugin& plugin) const {
  const Material below = nested(0);
  if (below.blend) reject(0, "expected a bsdf that is no blend or mixture");
  if (below.opacity) reject(0, "expected a bsdf that is not a mask: the mask goes around");
  if (isBent(below)) reject(0, "expected a bsdf without a bump or normal map");
  if (transmits(bsdfs(), below)) reject(0, "expected a bsdf that does not let light through");
  if (isCoat(bsdfs()[at(below.front)])) reject(0, "expected a bsdf that has no coat yet");
  const auto over = [&](int index) {
    Bsdf coat = createLocated(
        properties_, [&](const Properties& p) { return plugin.coat(p, bsdfs()[at(index)]); });
    context_.scene.bsdfs.push_back(std::move(coat));
    return static_cast<int>(bsdfs().size()) - 1;
  };
  Material material = below;
  material.front = over(below.front);
  if (below.twosided) material.back = below.back == below.front ? material.front : over(below.back);
  return material;
}

MaterialPtr NestedReader::part(int i) const {
  Material part = nested(i);
  if (part.opacity) reject(i, "expected a bsdf that is not a mask: the mask goes around");
  if (isBent(part)) reject(i, "expected a bsdf without a map: the map goes around");
  return std::make_shared<const Material>(std::move(part));
}

Material NestedReader::blendOf(MaterialPtr first, MaterialPtr second, TexturePtr weight,
                               float scale) const {
  Material material;
  if (first->frame || second->frame) material.frame = alongTangents();
  material.blend = std::make_shared<const Blend>(
      Blend{std::move(first), std::move(second), std::move(weight), scale});
  return material;
}

Material NestedReader::checked(Material material) const {
  if (depthOf(material) > kDeepestBlend)
    throw sourceError(element_.place(), properties_.description() + " has too many parts",
                      "expected at most " + std::to_string(kDeepestBlend + 1));
  std::set<float> indices;
  collectIndices(bsdfs(), material, indices);
  if (indices.size() > 1)
    throw sourceError(element_.place(),
                      properties_.description() + " of bsdfs that refract differently",
                      "expected one refractive index among its rough dielectrics");
  return material;
}

Material NestedReader::blend() const {
  if (properties_.nestedBsdfCount() != 2)
    throw sourceError(element_.place(), properties_.description() + " with one bsdf inside",
                      "expected two");
  return checked(blendOf(part(0), part(1), properties_.texture("weight"), 1));
}

Material NestedReader::mixture() const {
  std::vector<double> weights;
  try {
    weights = parseNumbers(properties_.string("weights"));
  } catch (const ValueError& e) {
    properties_.fail("weights", e.what());
  }
  const int count = properties_.nestedBsdfCount();
  if (static_cast<int>(weights.size()) != count)
    properties_.fail("weights", std::to_string(weights.size()) + " weights for " +
                                    std::to_string(count) + " bsdfs");
  double sum = 0;
  for (const double weight : weights) {
    constexpr double kMost = 1000;
    if (!(weight >= 0 && weight <= kMost))
      properties_.fail("weights", fmt::format("a weight is {:g}, expected numbers from 0 to {:g}",
                                              weight, kMost));
    sum += weight;
  }
  if (!(sum > 0)) properties_.fail("weights", "one weight must be positive");
  // The last ones first: each one against all that come after it.
  MaterialPtr rest = part(count - 1);
  double restWeight = weights.back();
  Material material = blendOf(rest, rest, constantTexture(Rgbf(0)), 1);
  for (int i = count - 2; i >= 0; --i) {
    const double both = weights[at(i)] + restWeight;
    const float share = both > 0 ? static_cast<float>(restWeight / both) : 0.5f;
    material = blendOf(part(i), rest, constantTexture(Rgbf(share)), 1);
    rest = std::make_shared<const Material>(material);
    restWeight = both;
  }
  Blend whole = *material.blend;
  if (sum <= 1 || !properties_.boolean("ensureEnergyConservation"))
    whole.scale = static_cast<float>(sum);
  else
    noteChange(properties_, "weights", fmt::format("a sum of {:g}", sum),
               "a sum of 1, to conserve energy");
  material.blend = std::make_shared<const Blend>(std::move(whole));
  return checked(std::move(material));
}

Material makeNested(ReaderContext& context, const XmlElement& element, const BsdfPlugin& plugin) {
  const NestedReader reader(context, element, plugin);
  if (plugin.coat) return reader.coated(plugin);
  if (plugin.name == "mask") return reader.mask();
  if (plugin.name == "bumpmap") return reader.mapped(FrameMap::Kind::kBump);
  if (plugin.name == "normalmap") return reader.mapped(FrameMap::Kind::kNormal);
  if (plugin.name == "blendbsdf") return reader.blend();
  if (plugin.name == "mixturebsdf") return reader.mixture();
  return reader.twosided();
}

bool isAnisotropic(const Bsdf& bsdf) {
  const auto* further = std::get_if<FurtherBsdf>(&bsdf);
  if (!further) return false;
  if (const auto* ward = std::get_if<Ward>(&further->bsdf)) return ward->alphaU != ward->alphaV;
  const auto* principled = std::get_if<Principled>(&further->bsdf);
  return principled && !principled->isIsotropic;
}

}  // namespace

int ReaderContext::makeMaterial(const XmlElement& element) {
  const BsdfPlugin& plugin = findPlugin(bsdfPlugins(), element, "bsdf");
  Material material;
  if (plugin.create) {
    const ElementProperties properties(*this, element,
                                       {"bsdf", plugin.parameters, plugin.nestedBsdfs, {}, false});
    Bsdf bsdf = createLocated(properties, plugin.create);
    if (isAnisotropic(bsdf)) material.frame = alongTangents();
    material.front = static_cast<int>(scene.bsdfs.size());
    scene.bsdfs.push_back(std::move(bsdf));
  } else if (plugin.name == "null") {
    // A mask that is all hole.
    const ElementProperties properties(*this, element, {"bsdf", {}, 0, {}, false});
    material.front = static_cast<int>(scene.bsdfs.size());
    scene.bsdfs.push_back(Diffuse{{}, constantTexture(Rgbf(0))});
    material.opacity = constantTexture(Rgbf(0));
  } else {
    material = makeNested(*this, element, plugin);
  }
  material.name = nameOf(element);
  material.plugin = std::string(plugin.name);
  scene.materials.push_back(std::move(material));
  return static_cast<int>(scene.materials.size()) - 1;
}

}  // namespace h2mc
