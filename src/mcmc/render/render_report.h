// SPDX-License-Identifier: MIT
// What there is to say of a render that is over.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "render/integrator/integrator.h"
#include "render/scene/option_set.h"

namespace h2mc {

// Size, integrator with its options, seed, threads, seconds, samples, mean luminance, and the integrator's own
// statistics: an object.
nlohmann::json renderReport(const OptionSet& integrator, std::uint64_t seed, int threads,
                            const RenderResult& result);

}  // namespace h2mc
