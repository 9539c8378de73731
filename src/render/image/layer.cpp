// SPDX-License-Identifier: MIT
#include "render/image/layer.h"

#include <cassert>

namespace h2mc {

const std::vector<LayerName>& layerNames() {
  // As Blender names passes of one value, "Depth.Z" and "IndexOB.X", and Mitsuba and pbrt those of three.
  static const std::vector<std::string> kRgb{"R", "G", "B"}, kXyz{"X", "Y", "Z"}, kZ{"Z"}, kX{"X"};
  static const std::vector<LayerName> names{
      {LayerKind::kAlbedo, "albedo", kRgb, "share of white light that the first surface scatters"},
      {LayerKind::kNormal, "normal", kXyz, "its shading normal, towards the camera"},
      {LayerKind::kDepth, "depth", kZ, "distance along the camera's axis"},
      {LayerKind::kPosition, "position", kXyz, "place in the world"},
      {LayerKind::kTime, "time", kX, "moment at which it is seen"},
      {LayerKind::kId, "id", kX, "number of the shape, from 1"},
      {LayerKind::kVariance, "variance", kRgb, "estimated variance of the pixel's value"},
      {LayerKind::kMutations, "mutations", kX, "mutations, or samples, on the pixel"}};
  return names;
}

const LayerName& layerName(LayerKind kind) { return layerNames()[static_cast<std::size_t>(kind)]; }

Layer makeLayer(LayerKind kind, std::size_t pixels) {
  const LayerName& name = layerName(kind);
  assert(name.kind == kind);
  return {name.name, name.channels, std::vector<float>(pixels * name.channels.size())};
}

Layer makeLayer(LayerKind kind, const Image& image) {
  Layer layer = makeLayer(kind, image.pixels.size());
  assert(layer.channels.size() == 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) layer.values[3 * i + at(c)] = image.pixels[i][c];
  return layer;
}

Image pictureOf(const Layer& layer, int width, int height) {
  Image image(width, height);
  const std::size_t channels = layer.channels.size();
  assert(layer.values.size() == image.pixels.size() * channels);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float* value = layer.values.data() + i * channels;
    image.pixels[i] = channels >= 3 ? Rgbf(value[0], value[1], value[2]) : Rgbf(value[0]);
  }
  return image;
}

}  // namespace h2mc
