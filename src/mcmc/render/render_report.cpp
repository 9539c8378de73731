// SPDX-License-Identifier: MIT
#include "mcmc/render/render_report.h"

namespace h2mc {

nlohmann::json renderReport(const OptionSet& integrator, std::uint64_t seed, int threads,
                            const RenderResult& result) {
  nlohmann::json parameters = nlohmann::json::object();
  for (const auto& [name, value] : integrator.values()) parameters[name] = value;
  return {
      {"width", result.image.width},
      {"height", result.image.height},
      {"integrator", integrator.integrator()},
      {"integratorOptions", parameters},
      {"seed", seed},
      {"threads", threads},
      {"wallSeconds", result.wallSeconds},
      {"cpuSeconds", result.cpuSeconds},
      {"samples", result.samples},
      {"sampleUnit", result.sampleUnit},
      {"meanLuminance", result.meanLuminance},
      {"meanLuminanceError", result.meanLuminanceError},
      {"interrupted", result.interrupted},
      {"statistics", result.statistics},
  };
}

}  // namespace h2mc
