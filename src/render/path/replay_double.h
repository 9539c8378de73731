// SPDX-License-Identifier: MIT
// The log target of a traced path in double: values for differences, and derivatives of any number of
// coordinates, for checking. The same templates as the float derivatives, compiled once each.
#pragma once

#include "ad/derivative_check.h"
#include "render/path/path.h"

namespace h2mc {

// log(target) at `u` on the path's frozen topology; -inf or NaN where nothing is there.
double replayInDouble(const Scene& scene, const Path& path, const double* u);

// Value, gradient and Hessian at `u`, of path.dimension() coordinates: blocks of four
// coordinates are active at a time, in pairs, so that one scalar type does for all path lengths.
ad::DerivativeValues differentiateInDouble(const Scene& scene, const Path& path, const double* u);

// The same in the vertex-local form.
ad::DerivativeValues differentiateLocallyInDouble(const Scene& scene, const Path& path,
                                                  const double* u);

}  // namespace h2mc
