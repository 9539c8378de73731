// SPDX-License-Identifier: MIT
// Gradient and Hessian of the log target with respect to a path's primary coordinates, by evaluating
// the contribution with ad::Dual2. Two forms of it:
//
// The plain one evaluates the whole path. A subpath has as many coordinates as have been drawn so far:
// its k-th vertex costs derivatives of 2k coordinates, and only the connection sees all of them. It is
// faster for short paths.
//
// The local one differentiates each vertex's own step and composes the steps (local_form.h): the cost
// of a vertex does not grow with the path. Where the steps' second derivatives all but cancel, or are
// likely to, it is done in double.
#pragma once

#include "render/path/path.h"

namespace h2mc {

// The longest paths of the plain form, in edges; builds for comparisons of the two may have more, each
// of which takes its time to compile.
#ifndef H2MC_DERIVATIVE_EDGES
#define H2MC_DERIVATIVE_EDGES 4
#endif
inline constexpr int kMaxPlainDimension = 2 * H2MC_DERIVATIVE_EDGES;

struct Derivative {
  int dimension = 0;
  float logTarget = 0;
  bool inDouble = false;  // float would not do
  float gradient[kMaxCoordinates];
  float hessian[kMaxCoordinates * (kMaxCoordinates + 1) / 2];  // lower, by rows

  // All entries finite.
  bool finite() const;
};

// d log(path.target) at path.sample, with the topology (triangles, lobes, light, visibility) frozen, in
// the form that is faster. result.dimension is path.dimension(), in the order of pathCoordinates().
// Precondition: path.target > 0.
void differentiate(const Scene& scene, const Path& path, Derivative& result);

// The same by either form. The plain one is there for paths of at most kMaxPlainDimension coordinates that
// depend on no shared ones, meet nothing perfectly smooth and graze nothing, and false for others.
bool differentiatePlainly(const Scene& scene, const Path& path, Derivative& result);
void differentiateLocally(const Scene& scene, const Path& path, Derivative& result);

}  // namespace h2mc
