// SPDX-License-Identifier: MIT
#include "render/integrator/common_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace h2mc {

int maxPathLength(const OptionSet& options) {
  const int maxDepth = options.integer("maxDepth");
  if (maxDepth != -1) requireRange(options, "maxDepth", 1, kNoLimit);
  const int longest = maxDepth == -1 ? kMaxPathLength : std::min(maxDepth, kMaxPathLength);
  if (options.has("minDepth") && options.integer("minDepth") > longest)
    throw OptionError(
        fmt::format("{}: minDepth {} is above maxDepth {}: there are no paths to render",
                    options.integrator(), options.integer("minDepth"), longest));
  return longest;
}

}  // namespace h2mc
