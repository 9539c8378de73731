// SPDX-License-Identifier: MIT
// What a comparison says: errors with intervals, fits, how much longer each method takes, ranks.
#pragma once

#include <optional>

#include "compare/comparison.h"
#include "compare/power_law.h"
#include "compare/repeats.h"

namespace h2mc {

// The methods are compared where the axis, seconds or mutations (samples) a pixel, has this position.
// All intervals are over the repeats, by Student's t distribution on the logarithms of errors.
struct MethodSummary {
  std::string name;
  // The error at the position: of the images within 5 % of it, else (byFit) by each repeat's fit.
  Estimate error;
  bool byFit = false;
  bool present = false;  // there is an error to rank by
  // error = c t^-p, the mean of the repeats' fits.
  PowerLaw fit;
  Estimate p;
  Estimate errorRatio;  // to the best one's error, at the position
  Estimate timeRatio;   // how many times longer it needs for the best one's error
  // Welch's test of the logarithms against the best one, Holm-adjusted over all pairs; not a number
  // with less than two repeats.
  double pValue = std::numeric_limits<double>::quiet_NaN();
  // 1: the best, and those not shown to be worse than it; else 1 + the number of methods shown to be better; 0: not
  // present.
  int rank = 0;
  std::string verdict;  // "best", "worse", "no difference shown", ...
};

struct Summary {
  std::string metric;
  bool timed = true;
  double position = 0;
  std::vector<MethodSummary> methods;  // in the order of the runs
  int best = -1;                       // index of the smallest error
  std::vector<std::size_t> order;  // of the methods: by rank, then by error; those not present last
};

// On the axis of time at the last mark; of a comparison in mutations at the longest time that all of
// h2mc's methods reach; likewise for mutations. Precondition: measured.
Summary summarise(const SceneRuns& runs, const ComparisonPlan& plan, const std::string& metric,
                  bool timed);

// The image of every method's first repeat that lies nearest to the position, for pictures side by
// side; null where there is none.
const Point* shownPoint(const MethodRuns& method, double position, bool timed);

}  // namespace h2mc
