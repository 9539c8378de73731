// SPDX-License-Identifier: MIT
#pragma once

#include "mcmc/methods/method.h"

namespace h2mc {

MetropolisMethod rjmltMethod();

}  // namespace h2mc
