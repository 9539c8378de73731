// SPDX-License-Identifier: MIT
// The layers that are asked of a render, from their names to their values.
#pragma once

#include <string>
#include <vector>

#include "render/image/layer.h"
#include "render/integrator/integrator.h"

namespace h2mc {

// The kinds of these names, without repetition. Throws UserError, which begins with `option`.
std::vector<LayerKind> layerKinds(const std::vector<std::string>& names, const std::string& option);
// All names, for messages.
std::vector<std::string> layerKindNames();

// Those of the kinds that a pass of camera rays makes (features.h).
std::vector<LayerKind> featuresAmong(const std::vector<LayerKind>& kinds);
// What the integrator has to be asked for the others.
PixelStatistics statisticsFor(const std::vector<LayerKind>& kinds);
// All of them: those that camera rays have made, and the others from a result that was asked for them.
std::vector<Layer> layersOf(const std::vector<LayerKind>& kinds, std::vector<Layer> features,
                            const RenderResult& result);

}  // namespace h2mc
