// SPDX-License-Identifier: MIT
// A technique's primary space as Python sees it.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "python/module.h"
#include "render/core/parallel.h"
#include "render/path/path.h"

namespace h2mc::python {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Doubles = Array<double>;

template <class T>
py::array_t<T> filled(std::vector<py::ssize_t> shape, T value) {
  py::array_t<T> array(std::move(shape));
  std::fill_n(array.mutable_data(), array.size(), value);
  return array;
}

// A technique's primary space as rows of an array: its own continuous coordinates, those that all techniques share,
// and last its choices.
class PrimarySpace {
 public:
  // Throws where there is no such technique.
  PrimarySpace(ScenePtr scene, int s, int t);

  const ScenePtr& scenePtr() const { return scene_; }
  const Scene& scene() const { return *scene_; }
  const Technique& technique() const { return technique_; }
  int dimension() const { return technique_.dimension() + scene_->shared().count(); }
  int columns() const { return dimension() + technique_.choices(); }

  std::vector<std::string> names() const;  // of the columns

  PrimarySample sample(const double* row) const;
  void setRow(const PrimarySample& sample, double* row) const;

  // Throws where the array is not one of rows in [0, 1).
  void check(const Doubles& x) const;

  // Traces every row; visit(i, path) of those that carry light, on many threads.
  template <class Visit>
  void forPaths(const Doubles& x, int threads, Visit&& visit) const {
    constexpr int kBlock = 64;
    const auto rows = static_cast<int>(x.shape(0));
    const double* const first = x.data();
    const py::gil_scoped_release released;
    parallelFor(threads, (rows + kBlock - 1) / kBlock, [&](int block) {
      Path path(technique_.length());
      for (int i = block * kBlock; i < std::min(rows, (block + 1) * kBlock); ++i) {
        path.technique = technique_;
        path.sample = sample(first + static_cast<py::ssize_t>(i) * columns());
        if (tracePath(scene(), path)) visit(i, path);
      }
    });
  }

  // Where a path's coordinate i is among the dimension() of all.
  int column(const Path& path, int i) const {
    const int skipped = path.moving || i < path.timeCoordinate() ? 0 : 1;
    return i + skipped;
  }

 private:
  ScenePtr scene_;
  Technique technique_;
};

// Of gradient and lower triangle by rows into rows of arrays.
template <class S, class T>
void spread(const PrimarySpace& space, const Path& path, const S* gradient, const S* hessian,
            T* toGradient, T* toHessian) {
  const int d = space.dimension(), n = path.dimension();
  std::fill_n(toGradient, d, T(0));
  std::fill_n(toHessian, d * d, T(0));
  for (int i = 0, k = 0; i < n; ++i) {
    const int row = space.column(path, i);
    toGradient[row] = gradient[i];
    for (int j = 0; j <= i; ++j, ++k) {
      const int column = space.column(path, j);
      toHessian[row * d + column] = toHessian[column * d + row] = hessian[k];
    }
  }
}

}  // namespace h2mc::python
