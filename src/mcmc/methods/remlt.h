// SPDX-License-Identifier: MIT
#pragma once

#include "mcmc/methods/method.h"

namespace h2mc {

// mmlt with replica exchange beside it.
MetropolisMethod remltMethod();

}  // namespace h2mc
