// Textures: colour as a function of (u, v).
#pragma once

#include <memory>
#include <span>
#include <variant>

#include "render/scene/plugin.h"
#include "render/texture/bitmap.h"
#include "render/texture/checkerboard.h"
#include "render/texture/constant.h"

namespace h2mc {

// Each has `template <class T> Rgb<T> evaluate(const Vec2<T>& uv) const`, differentiated with
// respect to uv within a cell of the texture, and `Rgbf average() const` and `Rgbf maximum() const`
// (per channel, over the texture).
using Texture = std::variant<ConstantTexture, CheckerboardTexture, BitmapTexture>;

// Shared by the BSDFs and lights that refer to it. Never null after a scene is read.
using TexturePtr = std::shared_ptr<const Texture>;

template <class T>
Rgb<T> evaluate(const Texture& texture, const Vec2<T>& uv) {
  return std::visit([&](const auto& t) -> Rgb<T> { return t.template evaluate<T>(uv); }, texture);
}

// texture(uv) * scale; a constant colour stays passive, so it costs three products with a plain
// number instead of three products of derivatives.
template <class T>
Rgb<T> modulate(const Texture& texture, const Vec2<T>& uv, const T& scale) {
  using S = Scalar<T>;
  if (const auto* constant = std::get_if<ConstantTexture>(&texture)) {
    const Vec3<S> c = plain<T>(constant->color);
    return {scale * c.x, scale * c.y, scale * c.z};
  }
  const Rgb<T> c = evaluate<T>(texture, uv);
  return {c.x * scale, c.y * scale, c.z * scale};
}

Rgbf average(const Texture& texture);
Rgbf maximum(const Texture& texture);
TexturePtr constantTexture(const Rgbf& color);

// Every texture a scene file can name.
std::span<const Plugin<TexturePtr>> texturePlugins();

}  // namespace h2mc
