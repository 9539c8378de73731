// SPDX-License-Identifier: MIT
#include "render/integrator/layers.h"

#include <algorithm>

#include "render/core/user_error.h"
#include "render/integrator/features.h"
#include "render/scene/suggestion.h"

namespace h2mc {

std::vector<std::string> layerKindNames() {
  std::vector<std::string> names;
  for (const LayerName& layer : layerNames()) names.emplace_back(layer.name);
  return names;
}

std::vector<LayerKind> layerKinds(const std::vector<std::string>& names,
                                  const std::string& option) {
  std::vector<LayerKind> kinds;
  for (const std::string& name : names) {
    const auto& all = layerNames();
    const auto layer =
        std::find_if(all.begin(), all.end(), [&](const LayerName& l) { return l.name == name; });
    if (layer == all.end())
      throw UserError(option + ": unknown layer \"" + name + "\"; " +
                      suggestion(name, layerKindNames()));
    if (std::find(kinds.begin(), kinds.end(), layer->kind) == kinds.end())
      kinds.push_back(layer->kind);
  }
  return kinds;
}

std::vector<LayerKind> featuresAmong(const std::vector<LayerKind>& kinds) {
  std::vector<LayerKind> features;
  std::copy_if(kinds.begin(), kinds.end(), std::back_inserter(features), isFeature);
  return features;
}

PixelStatistics statisticsFor(const std::vector<LayerKind>& kinds) {
  const auto wanted = [&](LayerKind kind) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  };
  return {wanted(LayerKind::kVariance), wanted(LayerKind::kMutations)};
}

std::vector<Layer> layersOf(const std::vector<LayerKind>& kinds, std::vector<Layer> features,
                            const RenderResult& result) {
  const PixelStatistics wanted = statisticsFor(kinds);
  if (wanted.variance) features.push_back(makeLayer(LayerKind::kVariance, result.variance));
  if (wanted.counts) {
    features.push_back(makeLayer(LayerKind::kMutations, 0));
    features.back().values = result.counts;
  }
  return features;
}

}  // namespace h2mc
