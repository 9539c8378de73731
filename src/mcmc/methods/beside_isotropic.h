// SPDX-License-Identifier: MIT
// Methods whose steps by derivatives stand beside isotropic ones and lens perturbations.
#pragma once

#include "mcmc/methods/method.h"

namespace h2mc {

// Such a method. `steps` is to be besideIsotropic() of its mutation.
MetropolisMethod methodBesideIsotropic(
    std::string_view name, std::string_view description,
    std::vector<MetropolisMethod::Step> (*steps)(const OptionSet& options));

// The mixture, by the options lensProbability, isotropicProbability and delayedRejection. `cost`: of the mutation, in
// isotropic steps; `delayed`: the mutation that tries it where an isotropic step was refused.
std::vector<MetropolisMethod::Step> besideIsotropic(const OptionSet& options,
                                                    std::string_view mutation, double cost,
                                                    std::string_view delayed);

}  // namespace h2mc
