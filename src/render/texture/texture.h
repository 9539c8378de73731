// SPDX-License-Identifier: MIT
// Textures: colour as a function of (u, v).
#pragma once

#include <memory>
#include <span>
#include <variant>

#include "render/scene/plugin.h"
#include "render/texture/bitmap.h"
#include "render/texture/checkerboard.h"
#include "render/texture/constant.h"
#include "render/texture/mesh_texture.h"
#include "render/texture/product.h"

namespace h2mc {

// Each has `template <class T> Rgb<T> evaluate(const Vec2<T>& uv) const`, differentiated with
// respect to uv within a cell of the texture or a triangle of the mesh, and `Rgbf average() const` and
// `Rgbf maximum() const` (per channel, over the texture). A class of its own, so that textures can have textures.
using AnyTexture =
    std::variant<ConstantTexture, CheckerboardTexture, BitmapTexture, ProductTexture, MeshTexture>;
struct Texture : AnyTexture {
  using AnyTexture::AnyTexture;
};

// Shared by the BSDFs and lights that refer to it. Never null after a scene is read.
using TexturePtr = std::shared_ptr<const Texture>;

template <class T>
Rgb<T> evaluate(const Texture& texture, const Vec2<T>& uv) {
  return std::visit([&](const auto& t) -> Rgb<T> { return t.template evaluate<T>(uv); }, texture);
}

// The same with its derivatives by uv; zero for textures that say none (all but bitmaps and what scales
// them): those are flat but for their borders.
template <class T>
TextureSlope<T> slopeOf(const Texture& texture, const Vec2<T>& uv) {
  return std::visit(
      [&](const auto& t) -> TextureSlope<T> {
        if constexpr (requires { t.template slope<T>(uv); })
          return t.template slope<T>(uv);
        else
          return {t.template evaluate<T>(uv), Rgb<T>(T(Scalar<T>(0))), Rgb<T>(T(Scalar<T>(0)))};
      },
      texture);
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

template <class T>
[[gnu::noinline]] Rgb<T> ProductTexture::evaluate(const Vec2<T>& uv) const {
  const Rgb<T> a = h2mc::evaluate<T>(*first, uv), b = h2mc::evaluate<T>(*second, uv);
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

template <class T>
[[gnu::noinline]] TextureSlope<T> ProductTexture::slope(const Vec2<T>& uv) const {
  const TextureSlope<T> a = slopeOf<T>(*first, uv), b = slopeOf<T>(*second, uv);
  return {a.value * b.value, a.du * b.value + a.value * b.du, a.dv * b.value + a.value * b.dv};
}

template <class T>
Vec2<T> MeshTexture::uvAt(const Vec2<T>& place) const {
  using S = Scalar<T>;
  const MeshPlace at(value2(place), mesh->columns, mesh->triangles.size());
  const T b1 = at.b1(place), b2 = at.b2(place);
  if (mesh->uvs.empty()) return {b1, b2};
  const glm::uvec3& t = mesh->triangles[at.triangle];
  const Vec2<S> a(mesh->uvs[t.x]), b(mesh->uvs[t.y]), c(mesh->uvs[t.z]);
  using ad::linear2;
  return {linear2(b1, b.x - a.x, b2, c.x - a.x) + a.x, linear2(b1, b.y - a.y, b2, c.y - a.y) + a.y};
}

template <class T>
[[gnu::noinline]] Rgb<T> MeshTexture::evaluate(const Vec2<T>& place) const {
  using S = Scalar<T>;
  if (texture) return h2mc::evaluate<T>(*texture, uvAt(place));
  const MeshPlace at(value2(place), mesh->columns, mesh->triangles.size());
  const T b1 = at.b1(place), b2 = at.b2(place);
  const glm::uvec3& t = mesh->triangles[at.triangle];
  const Vec3<S> a = plain<T>(mesh->colors[t.x]);
  const Vec3<S> d1 = plain<T>(mesh->colors[t.y]) - a, d2 = plain<T>(mesh->colors[t.z]) - a;
  using ad::linear2;
  Rgb<T> color;
  for (int i = 0; i < 3; ++i) {
    color[i] = linear2(b1, d1[i], b2, d2[i]) + a[i];
    // By rounding, at an edge of a triangle with a black corner.
    if (value(color[i]) < 0) color[i] = T(S(0));
  }
  return color;
}

template <class T>
[[gnu::noinline]] TextureSlope<T> MeshTexture::slope(const Vec2<T>& place) const {
  if (texture) return slopeOf<T>(*texture, uvAt(place));
  return {evaluate<T>(place), Rgb<T>(T(Scalar<T>(0))), Rgb<T>(T(Scalar<T>(0)))};
}

// The number that a texture stands for where one number is wanted (a roughness, a weight): the mean of
// its channels.
template <class T>
T scalarOf(const Rgb<T>& colour) {
  using ad::linear3;
  constexpr auto kThird = Scalar<T>(1) / Scalar<T>(3);
  return linear3(colour.x, kThird, colour.y, kThird, colour.z, kThird);
}

Rgbf average(const Texture& texture);
Rgbf maximum(const Texture& texture);
TexturePtr constantTexture(const Rgbf& color);

// Whether it is looked up by MeshPlaces, or one of those that it is made of.
bool isOnMesh(const Texture& texture);

// Every texture a scene file can name. "vertexcolors" and "mesh_attribute", which ask the scene reader for a mesh, have
// no `create`.
std::span<const Plugin<TexturePtr>> texturePlugins();

}  // namespace h2mc
