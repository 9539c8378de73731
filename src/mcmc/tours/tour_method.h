// SPDX-License-Identifier: MIT
// A method of tours: which mutations they run, and by what rule they begin and end.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "mcmc/chain/kernel_mixture.h"
#include "mcmc/tours/tour_rule.h"
#include "render/scene/option_set.h"

namespace h2mc {

// A method is a function that returns this, in a file of its own, and a line in tour_method.cpp. All run the same
// mixture of small steps, whose shares are options; there are no large ones.
struct TourMethod {
  std::string_view name, description;  // one line
  // The options besides those that all methods of tours have.
  std::vector<Parameter> ownParameters;
  // Throws OptionError for values of its own options that are out of range.
  void (*check)(const OptionSet& options);
  // By an estimate of the target's mean, > 0.
  std::unique_ptr<TourRule> (*rule)(const OptionSet& options, double meanTarget);
  // Of one sample, on average.
  double (*mutationsASample)(const OptionSet& options);

  // All options. Filled in by the list.
  std::vector<Parameter> parameters = {};
  IntegratorPlugin plugin() const { return {name, description, parameters}; }
};

std::span<const TourMethod> tourMethods();

// Throws OptionError for values out of range.
void checkOptions(const TourMethod& method, const OptionSet& options);

// The mixture that the options ask for. Keeps a reference to the target.
KernelMixture makeTourKernels(const PathTarget& target, const OptionSet& options, int minLength,
                              double meanTarget);

}  // namespace h2mc
