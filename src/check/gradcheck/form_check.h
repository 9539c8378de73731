// SPDX-License-Identifier: MIT
// A float derivative held against the one in double.
#pragma once

#include "check/gradcheck/gradcheck.h"
#include "render/path/derivative.h"

namespace h2mc {

// The same numbers in double.
void copyDerivative(const Derivative& derivative, ad::DerivativeValues& result);

// The errors of `found` as gradcheck.h measures them; kNotFinite where it is not, else kAgrees: nothing
// is judged. Precondition: `exact` is finite and of the same dimension.
FormCheck formErrors(const ad::DerivativeValues& found, const ad::DerivativeValues& exact);

// `exact` is the derivative in double at path.sample, finite. Tolerance and verdicts as gradcheck.h
// says.
FormCheck checkForm(const Scene& scene, const Path& path, const ad::DerivativeValues& exact,
                    const DerivativeForm& form, const GradcheckSettings& settings);

}  // namespace h2mc
