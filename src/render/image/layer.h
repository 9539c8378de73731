// SPDX-License-Identifier: MIT
// Layers: pictures of other things than light, which an EXR holds beside the picture.
#pragma once

#include <string>
#include <vector>

#include "render/image/image.h"

namespace h2mc {

// Channel c of a layer is named "name.channels[c]" in the file, "normal.X".
struct Layer {
  std::string name;
  std::vector<std::string> channels;
  // Row by row from the top, all channels of a pixel together.
  std::vector<float> values;
};

// The layers' names, in this order.
enum class LayerKind { kAlbedo, kNormal, kDepth, kPosition, kTime, kId, kVariance, kMutations };
struct LayerName {
  LayerKind kind;
  const char* name;
  std::vector<std::string> channels;
  const char* description;
};
const std::vector<LayerName>& layerNames();
const LayerName& layerName(LayerKind kind);

// An empty layer of this kind for so many pixels: zeros.
Layer makeLayer(LayerKind kind, std::size_t pixels);
// The same with the picture's values. Precondition: a kind of three channels.
Layer makeLayer(LayerKind kind, const Image& image);

// As a picture: three channels as they are, a single one spread over all three, the first one of others.
// Precondition: it is of so many pixels.
Image pictureOf(const Layer& layer, int width, int height);

}  // namespace h2mc
