#include "render/texture/texture.h"

#include "render/image/image_io.h"
#include "render/scene/properties.h"

namespace h2mc {

namespace {

using enum ParameterType;

constexpr Parameter kCheckerboardParameters[] = {
    {"color0", kColor, "0.4", "colour of the field at (0, 0)"},
    {"color1", kColor, "0.2", "colour of its neighbours"},
    {"uscale", kNumber, "", "factor for u; uvscale by default"},
    {"vscale", kNumber, "", "factor for v; uvscale by default"},
    {"uvscale", kNumber, "1", "factor for both u and v"},
    {"uoffset", kNumber, "0", "added to the scaled u"},
    {"voffset", kNumber, "0", "added to the scaled v"},
};

constexpr Parameter kBitmapParameters[] = {
    {"filename", kString, "", "the picture"},
    {"gamma", kNumber, "0", "-1: sRGB, 1: linear, 0: as the file says, else an exponent"},
    {"raw", kBoolean, "false", "numbers instead of colours: the same as gamma 1"},
    {"wrapMode", kString, "repeat", "what lies outside the unit square",
     "repeat|mirror|clamp|zero|black|one|white"},
    {"wrapModeU", kString, "", "the same along u alone",
     "repeat|mirror|clamp|zero|black|one|white"},
    {"wrapModeV", kString, "", "the same along v alone",
     "repeat|mirror|clamp|zero|black|one|white"},
    {"filterType", kString, "ewa",
     "nearest, or else bilinear at full resolution (ewa and trilinear are read as that)",
     "nearest|bilinear|trilinear|ewa"},
    {"uscale", kNumber, "", "factor for u; uvscale by default"},
    {"vscale", kNumber, "", "factor for v; uvscale by default"},
    {"uvscale", kNumber, "1", "factor for both u and v"},
    {"uoffset", kNumber, "0", "added to the scaled u"},
    {"voffset", kNumber, "0", "added to the scaled v"},
    {"maxAnisotropy", kNumber, "20", "of the ewa filter", "", "", true},
    {"cache", kBoolean, "false", "keep filtered copies in files", "", "", true},
};

TextureMapping readMapping(const Properties& p) {
  const float both = p.number("uvscale");
  return {{p.given("uscale") ? p.number("uscale") : both,
           p.given("vscale") ? p.number("vscale") : both},
          {p.number("uoffset"), p.number("voffset")}};
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
    t.image = BitmapTexture::load(file, p.boolean("raw") ? 1 : p.number("gamma"));
  } catch (const ImageError& e) {
    p.fail("filename", e.what());
  }
  if (t.image->pixels.empty()) p.fail("filename", "the picture is empty");
  t.mapping = readMapping(p);
  t.wrapU = readWrapMode(p, "wrapModeU");
  t.wrapV = readWrapMode(p, "wrapModeV");
  t.nearest = p.string("filterType") == "nearest";
  return std::make_shared<const Texture>(std::move(t));
}

constexpr Plugin<TexturePtr> kPlugins[] = {
    {"bitmap", "A picture from a file", kBitmapParameters, createBitmap},
    {"checkerboard", "Fields of two colours by turns", kCheckerboardParameters, createCheckerboard},
};

}  // namespace

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
