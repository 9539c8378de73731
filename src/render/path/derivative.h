// Gradient and Hessian of the log target with respect to a path's primary coordinates, by evaluating
// the contribution with ad::Dual2: the plain whole-path form.
//
// A subpath is evaluated with as many coordinates as have been drawn so far: its k-th vertex costs
// derivatives of 2k coordinates, not of all. Only the connection sees all of them.
//
// The vertex-local form (differentiate each vertex's own step, then compose) is to stand beside
// this one, as another way to fill a Derivative; this one stays as its oracle.
#pragma once

#include "render/path/path.h"

namespace h2mc {

// The longest paths of the plain form, in edges. Builds that are there to find mistakes, such as those
// under the sanitizers, make do with fewer: each takes a minute to compile.
#ifndef H2MC_DERIVATIVE_EDGES
#define H2MC_DERIVATIVE_EDGES 8
#endif
// Its coordinates: two an edge, and time.
inline constexpr int kMaxDerivativeDimension = 2 * H2MC_DERIVATIVE_EDGES + 1;

struct Derivative {
  int dimension = 0;
  float logTarget = 0;
  float gradient[kMaxDerivativeDimension];
  float hessian[kMaxDerivativeDimension * (kMaxDerivativeDimension + 1) / 2];  // lower, by rows

  // All entries finite.
  bool finite() const;
};

// d log(path.target) at path.sample, with the topology (triangles, lobes, light, visibility) frozen.
// result.dimension is path.dimension(): where the path depends on time, that is the last coordinate.
// False when path.dimension() > kMaxDerivativeDimension. Precondition: path.target > 0.
bool differentiate(const Scene& scene, const Path& path, Derivative& result);

}  // namespace h2mc
