// SPDX-License-Identifier: MIT
#include "mcmc/tours/tour_method.h"

#include <algorithm>
#include <array>

#include "mcmc/mutations/bidirectional_large_step.h"
#include "mcmc/mutations/mutations.h"
#include "mcmc/mutations/technique_distribution.h"
#include "mcmc/render/split_parameters.h"
#include "mcmc/tours/erpt.h"
#include "mcmc/tours/restore.h"

namespace h2mc {
namespace {

struct StepShare {
  std::string_view option, mutation;
  std::optional<double> cost;  // in isotropic steps, as the methods of chains have it
};
constexpr std::array<StepShare, 10> kShares = {{{"lensShare", "lens", {}},
                                                {"isotropicShare", "isotropic", 1},
                                                {"hamiltonianShare", "hamiltonian", 4},
                                                {"langevinShare", "langevin", 2.5},
                                                {"veachLensShare", "veachLens", {}},
                                                {"causticShare", "caustic", {}},
                                                {"multiChainShare", "multiChain", {}},
                                                {"lensSubpathShare", "lensSubpath", {}},
                                                {"bidirectionalShare", "veachBidirectional", {}},
                                                {"techniqueShare", "technique", {}}}};

constexpr Parameter kParameters[] = {
    kMaxDepthParameter,
    kMinDepthParameter,
    kMutationsPerPixelParameter,
    kDirectSamplesParameter,
    {"luminanceSamples", ParameterType::kInteger, "15000",
     "bidirectional samples by which the brightness is first guessed: it sets how many tours there "
     "are, not how bright the picture is"},
    {"targetLimit", ParameterType::kNumber, "1000",
     "chains take paths that are brighter than this many times the mean for as bright as that, "
     "which leaves the picture's mean as it is; 0: no limit"},
    {"lensShare", ParameterType::kNumber, "0.3",
     "share of lens perturbations; the shares count in proportion to their sum, and isotropic, "
     "Hamiltonian and Langevin steps divide what they have together by what is accepted"},
    {"isotropicShare", ParameterType::kNumber, "0.35", "the same of isotropic steps"},
    {"hamiltonianShare", ParameterType::kNumber, "0.35", "the same of Hamiltonian steps"},
    {"langevinShare", ParameterType::kNumber, "0", "the same of Langevin steps"},
    {"veachLensShare", ParameterType::kNumber, "0", "the same of Veach's lens perturbations"},
    {"causticShare", ParameterType::kNumber, "0", "the same of caustic perturbations"},
    {"multiChainShare", ParameterType::kNumber, "0", "the same of multi-chain perturbations"},
    {"lensSubpathShare", ParameterType::kNumber, "0", "the same of lens subpath mutations"},
    {"bidirectionalShare", ParameterType::kNumber, "0",
     "the same of Veach's bidirectional mutations"},
    {"techniqueShare", ParameterType::kNumber, "0", "the same of changes of technique"}};

void add(std::span<const Parameter> more, std::vector<Parameter>& parameters) {
  for (const Parameter& p : more)
    if (std::none_of(parameters.begin(), parameters.end(),
                     [&](const Parameter& had) { return had.name == p.name; }))
      parameters.push_back(p);
}

}  // namespace

std::span<const TourMethod> tourMethods() {
  // A new method is a line here.
  static const std::vector<TourMethod> list = [] {
    std::vector<TourMethod> methods{erptMethod(), restoreMethod()};
    for (TourMethod& method : methods) {
      add(kParameters, method.parameters);
      add(method.ownParameters, method.parameters);
      for (const StepShare& share : kShares)
        add(mutationNamed(share.mutation).parameters, method.parameters);
    }
    return methods;
  }();
  return list;
}

void checkOptions(const TourMethod& method, const OptionSet& options) {
  checkSplitOptions(options);
  requireRange(options, "luminanceSamples", 1, kNoLimit);
  requireRange(options, "targetLimit", 0, kNoLimit);
  bool any = false;
  for (const StepShare& share : kShares) {
    requireRange(options, share.option, 0, 1);
    any |= options.number(share.option) > 0;
    if (const auto check = mutationNamed(share.mutation).check) check(options);
  }
  if (!any)
    throw OptionError(std::string(method.name) +
                      ": one of the mutations' shares must be more than 0");
  method.check(options);
}

KernelMixture makeTourKernels(const PathTarget& target, const OptionSet& options, int minLength,
                              double meanTarget) {
  // Nobody draws one technique.
  static const TechniqueDistribution kNone(1, 1);
  double sum = 0;
  for (const StepShare& share : kShares) sum += options.number(share.option);
  SlotNumbers slots;
  const MutationSetup setup{target, kNone, minLength, options, slots};
  KernelMixture kernels;
  kernels.large = std::make_unique<BidirectionalLargeStep>(target, minLength, slots);
  kernels.largeProbability = 0;
  kernels.meanTarget = meanTarget;
  for (const StepShare& share : kShares)
    if (const double own = options.number(share.option); own > 0)
      kernels.small.push_back({mutationNamed(share.mutation).create(setup), own / sum, share.cost});
  kernels.width = static_cast<float>(target.scene().film.width);
  kernels.height = static_cast<float>(target.scene().film.height);
  return kernels;
}

}  // namespace h2mc
