// SPDX-License-Identifier: MIT
// Single paths in Python.
#pragma once

#include <utility>

#include "python/primary_space.h"

namespace h2mc::python {

// A path that was traced; what is discrete about it is held fixed as its continuous coordinates move.
class TracedPath {
 public:
  TracedPath(const PrimarySpace& space, Path path) : space_(space), path_(std::move(path)) {}

  const Path& path() const { return path_; }

  // The continuous ones, (d,).
  Doubles coordinates() const;
  double logTarget(const Doubles& x) const;
  // Gradient and Hessian.
  std::pair<Doubles, Doubles> derivatives(const Doubles& x) const;
  Doubles vertices() const;

 private:
  // The coordinates that the path depends on.
  void dependent(const Doubles& x, double* u) const;

  PrimarySpace space_;
  Path path_;
};

}  // namespace h2mc::python
