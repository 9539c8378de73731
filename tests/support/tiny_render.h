// SPDX-License-Identifier: MIT
// Renders that take a moment.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "image_check.h"

namespace h2mc::test {

inline Scene tinyRing() { return readTestScene(H2MC_SOURCE_DIR "/scenes/ring/ring.xml", 24, 18); }

// By an integrator's name; with few chains and little preparation, and further options of those that it has.
inline RenderResult renderTiny(const std::string& integrator, const Scene& scene,
                               const RenderRequest& request,
                               std::vector<std::pair<const char*, std::string>> options) {
  options.insert(options.begin(), {{"chains", "16"},
                                   {"bootstrapSamples", "2000"},
                                   {"luminanceSamples", "2000"},
                                   {"chainLength", "5"},
                                   {"tourLength", "5"}});
  for (const IntegratorFactory& factory : allIntegrators())
    if (factory.plugin.name == integrator) {
      OptionSet set(factory.plugin);
      for (const auto& [name, value] : options)
        if (set.has(name)) set.set(name, value);
      return factory.create(set)->render(scene, request);
    }
  throw std::runtime_error("no such integrator: " + integrator);
}

}  // namespace h2mc::test
