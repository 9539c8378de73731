// SPDX-License-Identifier: MIT
#pragma once

#include "mcmc/tours/tour_method.h"

namespace h2mc {

TourMethod restoreMethod();

}  // namespace h2mc
