// SPDX-License-Identifier: MIT
#include "render/texture/texture.h"

#include "render/image/image_io.h"
#include "render/scene/change_note.h"
#include "render/scene/properties.h"
#include "render/scene/ranges.h"
#include "render/scene/texel_check.h"

namespace h2mc {

namespace {

using enum ParameterType;

constexpr Parameter kUScale = {"uscale", kNumber, "", "factor for u; uvscale by default"};
constexpr Parameter kVScale = {"vscale", kNumber, "", "factor for v; uvscale by default"};
constexpr Parameter kUVScale = {"uvscale", kNumber, "1", "factor for both u and v"};
constexpr Parameter kUOffset = {"uoffset", kNumber, "0", "added to the scaled u"};
constexpr Parameter kVOffset = {"voffset", kNumber, "0", "added to the scaled v"};
constexpr Parameter kToUv = {"toUv", kTransform, "",
                             "of (u, v, 0), before the factors; what it makes of z is not used"};

constexpr Parameter kCheckerboardParameters[] = {
    {"color0", kColor, "0.4", "colour of the field at (0, 0)"},
    {"color1", kColor, "0.2", "colour of its neighbours"},
    kUScale,
    kVScale,
    kUVScale,
    kUOffset,
    kVOffset,
    kToUv,
};

constexpr Parameter kBitmapParameters[] = {
    {"filename", kString, "", "the picture"},
    {"gamma", kNumber, "0", "-1: sRGB, 1: linear, 0: as the file says, else an exponent"},
    {"raw", kBoolean, "false", "numbers instead of colours: the same as gamma 1"},
    {"channel", kString, "",
     "one channel of the picture alone, as grey: r, g, b, a or y; a is linear"},
    {"wrapMode", kString, "repeat", "what lies outside the unit square",
     "repeat|mirror|clamp|zero|black|one|white"},
    {"wrapModeU", kString, "", "the same along u alone",
     "repeat|mirror|clamp|zero|black|one|white"},
    {"wrapModeV", kString, "", "the same along v alone",
     "repeat|mirror|clamp|zero|black|one|white"},
    {"filterType", kString, "ewa",
     "nearest, or else bilinear at full resolution (ewa and trilinear are read as that)",
     "nearest|bilinear|trilinear|ewa"},
    kUScale,
    kVScale,
    kUVScale,
    kUOffset,
    kVOffset,
    kToUv,
    {"maxAnisotropy", kNumber, "20", "of the ewa filter", "", "", true},
    {"cache", kBoolean, "false", "keep filtered copies in files", "", "", true},
    {"format", kString, "", "how other renderers keep it in memory", "", "", true},
    {"accel", kBoolean, "false", "how other renderers look it up", "", "", true},
};

TextureMapping readMapping(const Properties& p) {
  const float both = p.number("uvscale");
  const Vec2f scale(p.given("uscale") ? p.number("uscale") : both,
                    p.given("vscale") ? p.number("vscale") : both);
  const Mat4 m = p.transform("toUv");  // by columns
  return {{scale.x * m[0].x, scale.y * m[1].y},
          {scale.x * m[3].x + p.number("uoffset"), scale.y * m[3].y + p.number("voffset")},
          {scale.x * m[1].x, scale.y * m[0].y}};
}

TexturePtr createCheckerboard(const Properties& p) {
  return std::make_shared<const Texture>(
      CheckerboardTexture{p.color("color0"), p.color("color1"), readMapping(p)});
}

WrapMode readWrapMode(const Properties& p, std::string_view name) {
  const std::string mode = p.string(p.given(name) ? name : "wrapMode");
  if (mode == "mirror") return WrapMode::kMirror;
  if (mode == "clamp") return WrapMode::kClamp;
  if (mode == "zero" || mode == "black") return WrapMode::kZero;
  if (mode == "one" || mode == "white") return WrapMode::kOne;
  return WrapMode::kRepeat;
}

TexturePtr createBitmap(const Properties& p) {
  BitmapTexture t;
  const std::string file = p.file("filename");
  try {
    t.image = BitmapTexture::load(file, p.boolean("raw") ? 1 : readGamma(p),
                                  p.given("channel") ? p.string("channel") : "");
  } catch (const ImageError& e) {
    p.fail("filename", e.what());
  }
  if (t.image->pixels.empty()) p.fail("filename", "the picture is empty");
  if (auto mended = mendedTexels(p, *t.image))
    t.image = std::make_shared<const Image>(*std::move(mended));
  t.mapping = readMapping(p);
  t.wrapU = readWrapMode(p, "wrapModeU");
  t.wrapV = readWrapMode(p, "wrapModeV");
  const std::string filter = p.string("filterType");
  t.nearest = filter == "nearest";
  if (p.given("filterType") && filter != "nearest" && filter != "bilinear")
    noteChange(p, "filterType", filter, "bilinear at full resolution");
  return std::make_shared<const Texture>(std::move(t));
}

constexpr Parameter kScaleParameters[] = {
    {"texture", kTexture, "", "what is scaled", "", "", false, false, true},
    {"scale", kTexture, "1", "a factor, colour or texture to multiply it by"},
};

TexturePtr createScale(const Properties& p) {
  const TexturePtr scaled = p.texture("texture"), scale = p.texture("scale");
  const auto* a = std::get_if<ConstantTexture>(scaled.get());
  const auto* b = std::get_if<ConstantTexture>(scale.get());
  if (a && b) return constantTexture(a->color * b->color);
  return std::make_shared<const Texture>(ProductTexture{scaled, scale});
}

// f of the products of two textures' colours at the centres of a grid's fields, one after the other.
template <class F>
void overProducts(const ProductTexture& product, F&& f) {
  constexpr int kGrid = 256;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const auto centre = [](int k) { return (static_cast<float>(k) + 0.5f) / kGrid; };
    f(product.evaluate<float>({centre(i % kGrid), centre(i / kGrid)}));
  }
}

// Whether average and maximum are the products of those of the two textures. On meshes the maximum is a bound, and the
// average an estimate.
bool isSeparate(const ProductTexture& product) {
  const auto simple = [](const Texture& t) {
    return std::holds_alternative<ConstantTexture>(t) || isOnMesh(t);
  };
  return simple(*product.first) || simple(*product.second);
}

constexpr Parameter kMeshAttributeParameters[] = {
    {"name", kString, "vertex_color", "the attribute: the colours of the vertices alone"},
    {"scale", kNumber, "1", "a factor"},
};

constexpr Plugin<TexturePtr> kPlugins[] = {
    {"bitmap", "A picture from a file", kBitmapParameters, createBitmap},
    {"checkerboard", "Fields of two colours by turns", kCheckerboardParameters, createCheckerboard},
    {"scale", "A texture times a colour or another texture", kScaleParameters, createScale},
    {"vertexcolors", "The colours of a mesh's vertices", {}, nullptr},
    {"mesh_attribute", "The same by Mitsuba 3's name", kMeshAttributeParameters, nullptr},
};

}  // namespace

Rgbf ProductTexture::average() const {
  if (isSeparate(*this)) return h2mc::average(*first) * h2mc::average(*second);
  Vec3<double> sum(0);
  double count = 0;
  overProducts(*this, [&](const Rgbf& c) {
    sum += Vec3<double>(c);
    ++count;
  });
  return Rgbf(sum / count);
}

Rgbf ProductTexture::maximum() const {
  if (isSeparate(*this)) return h2mc::maximum(*first) * h2mc::maximum(*second);
  Rgbf largest(0);
  overProducts(*this, [&](const Rgbf& c) { largest = glm::max(largest, c); });
  return largest;
}

Rgbf MeshTexture::average() const {
  if (texture) return h2mc::average(*texture);
  Vec3<double> sum(0);
  for (const glm::uvec3& t : mesh->triangles)
    for (int i = 0; i < 3; ++i) sum += Vec3<double>(mesh->colors[t[i]]);
  return Rgbf(sum / (3.0 * double(mesh->triangles.size())));
}

Rgbf MeshTexture::maximum() const {
  if (texture) return h2mc::maximum(*texture);
  Rgbf largest(0);
  for (const Rgbf& c : mesh->colors) largest = glm::max(largest, c);
  return largest;
}

bool isOnMesh(const Texture& texture) {
  const auto* product = std::get_if<ProductTexture>(&texture);
  return std::holds_alternative<MeshTexture>(texture) ||
         (product && (isOnMesh(*product->first) || isOnMesh(*product->second)));
}

Rgbf average(const Texture& texture) {
  return std::visit([](const auto& t) { return t.average(); }, texture);
}

Rgbf maximum(const Texture& texture) {
  return std::visit([](const auto& t) { return t.maximum(); }, texture);
}

TexturePtr constantTexture(const Rgbf& color) {
  return std::make_shared<const Texture>(ConstantTexture{color});
}

std::span<const Plugin<TexturePtr>> texturePlugins() { return kPlugins; }

}  // namespace h2mc
