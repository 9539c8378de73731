// SPDX-License-Identifier: MIT
#include "mcmc/tours/restore.h"

namespace h2mc {

TourMethod restoreMethod() {
  return {"restore",
          "jump-restore light transport: chains that die where it is dark and are born anew at "
          "fresh bidirectional samples [Holl et al. 2024]",
          {{"tourLength", ParameterType::kNumber, "20",
            "mutations of all chains that begin at a bidirectional sample, on average"}},
          [](const OptionSet& options) { requireRange(options, "tourLength", 1e-3, 1e6); },
          [](const OptionSet& options, double meanTarget) {
            return regeneration(meanTarget, options.number("tourLength"));
          },
          [](const OptionSet& options) { return options.number("tourLength"); }};
}

}  // namespace h2mc
