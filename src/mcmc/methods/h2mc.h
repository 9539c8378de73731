// SPDX-License-Identifier: MIT
#pragma once

#include "mcmc/methods/method.h"

namespace h2mc {

MetropolisMethod h2mcMethod();

}  // namespace h2mc
