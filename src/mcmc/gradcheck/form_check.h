// A float derivative held against the one in double.
#pragma once

#include "mcmc/gradcheck/gradcheck.h"

namespace h2mc {

// `exact` is the derivative in double at path.sample, finite. Tolerance and verdicts as gradcheck.h
// says.
FormCheck checkForm(const Scene& scene, const Path& path, const ad::DerivativeValues& exact,
                    const DerivativeForm& form, const GradcheckSettings& settings);

}  // namespace h2mc
