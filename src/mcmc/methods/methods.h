// SPDX-License-Identifier: MIT
// The list of Metropolis methods.
#pragma once

#include <memory>

#include "mcmc/methods/method.h"

namespace h2mc {

std::span<const MetropolisMethod> metropolisMethods();

// By name. Precondition: it is in the list.
const MetropolisMethod& methodNamed(std::string_view name);

}  // namespace h2mc
