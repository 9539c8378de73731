// SPDX-License-Identifier: MIT
// Paths in Python: the target on a technique's primary space, its derivatives, and single paths.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "check/gradcheck/path_source.h"
#include "python/module.h"
#include "render/core/parallel.h"
#include "render/core/unit_interval.h"
#include "render/path/assemble.h"
#include "render/path/derivative.h"
#include "render/path/replay_double.h"

namespace h2mc::python {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kStream = 0x7079;

using Doubles = Array<double>;

// A technique's primary space as rows of an array: its own continuous coordinates, those that all techniques share,
// and last its choices.
class PrimarySpace {
 public:
  PrimarySpace(ScenePtr scene, int s, int t) : scene_(std::move(scene)), technique_{s, t} {
    if (s < 0 || t < 1 || technique_.length() < 1 || technique_.length() > kMaxPathLength ||
        technique_ == Technique{1, 1})
      throw UserError(
          fmt::format("there is no technique s={} t={} of 1 to {} edges", s, t, kMaxPathLength));
  }

  const ScenePtr& scenePtr() const { return scene_; }
  const Scene& scene() const { return *scene_; }
  const Technique& technique() const { return technique_; }
  int dimension() const { return technique_.dimension() + scene_->shared().count(); }
  int columns() const { return dimension() + technique_.choices(); }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (int i = 0; i < technique_.dimension(); ++i) names.push_back(fmt::format("u{}", i));
    if (scene_->shared().aperture) names.insert(names.end(), {"aperture0", "aperture1"});
    if (scene_->shared().time) names.emplace_back("time");
    for (int i = 0; i < technique_.choices(); ++i) names.push_back(fmt::format("choice{}", i));
    return names;
  }

  PrimarySample sample(const double* row) const {
    PrimarySample sample;
    const int own = technique_.dimension();
    for (int i = 0; i < own; ++i) sample.u[at(i)] = toUnitInterval(row[i]);
    float shared[kMostShared];
    for (int i = 0; i < scene_->shared().count(); ++i) shared[i] = toUnitInterval(row[own + i]);
    setShared(scene_->shared(), shared, sample);
    for (int i = 0; i < technique_.choices(); ++i)
      sample.choice[at(i)] = toUnitInterval(row[dimension() + i]);
    return sample;
  }
  void setRow(const PrimarySample& sample, double* row) const {
    std::copy_n(sample.u.begin(), technique_.dimension(), row);
    getShared(scene_->shared(), sample, row + technique_.dimension());
    std::copy_n(sample.choice.begin(), technique_.choices(), row + dimension());
  }

  // Throws where the array is not one of rows in [0, 1).
  void check(const Doubles& x) const {
    if (x.ndim() != 2 || x.shape(1) != columns())
      throw UserError(fmt::format("expected an array of shape (n, {}): coordinates of s={} t={}",
                                  columns(), technique_.s, technique_.t));
    for (py::ssize_t i = 0; i < x.size(); ++i)
      if (const double value = x.data()[i]; !(value >= 0 && value < 1))
        throw UserError(fmt::format("row {}: {} is {:g}, expected a number in [0, 1)",
                                    i / columns(), names()[at(i % columns())], value));
  }

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

template <class T>
py::array_t<T> filled(std::vector<py::ssize_t> shape, T value) {
  py::array_t<T> array(std::move(shape));
  std::fill_n(array.mutable_data(), array.size(), value);
  return array;
}

py::dict evaluate(const PrimarySpace& space, const Doubles& x, int threads) {
  space.check(x);
  const py::ssize_t n = x.shape(0);
  auto contribution = filled<float>({n, 3}, 0), film = filled<float>({n, 2}, 0);
  auto target = filled<float>({n}, 0);
  float *c = contribution.mutable_data(), *f = film.mutable_data(), *t = target.mutable_data();
  space.forPaths(x, threads, [&](int i, const Path& path) {
    for (int k = 0; k < 3; ++k) c[3 * i + k] = path.contribution[k];
    f[2 * i] = path.filmX;
    f[2 * i + 1] = path.filmY;
    t[i] = path.target;
  });
  py::dict result;
  result["contribution"] = contribution;
  result["target"] = target;
  result["film"] = film;
  return result;
}

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

template <class T>
py::tuple differentiateAs(const PrimarySpace& space, const Doubles& x, int threads) {
  const py::ssize_t n = x.shape(0), d = space.dimension();
  const T none = std::numeric_limits<T>::quiet_NaN();
  auto value = filled<T>({n}, -std::numeric_limits<T>::infinity());
  auto gradient = filled<T>({n, d}, none), hessian = filled<T>({n, d, d}, none);
  T *v = value.mutable_data(), *g = gradient.mutable_data(), *h = hessian.mutable_data();
  space.forPaths(x, threads, [&](int i, const Path& path) {
    T *toGradient = g + i * d, *toHessian = h + i * d * d;
    if constexpr (std::is_same_v<T, float>) {
      Derivative r;
      differentiate(space.scene(), path, r);
      v[i] = r.logTarget;
      spread(space, path, r.gradient, r.hessian, toGradient, toHessian);
    } else {
      double u[kMaxCoordinates];
      pathCoordinates(path, u);
      const ad::DerivativeValues r = differentiateInDouble(space.scene(), path, u);
      v[i] = r.value;
      spread(space, path, r.gradient.data(), r.hessian.data(), toGradient, toHessian);
    }
  });
  return py::make_tuple(value, gradient, hessian);
}

py::tuple differentiateRows(const PrimarySpace& space, const Doubles& x, const py::object& dtype,
                            int threads) {
  space.check(x);
  const auto type = py::dtype::from_args(dtype);
  if (type.equal(py::dtype::of<float>())) return differentiateAs<float>(space, x, threads);
  if (type.equal(py::dtype::of<double>())) return differentiateAs<double>(space, x, threads);
  throw UserError("dtype: expected float32 or float64");
}

Doubles samplePaths(const PrimarySpace& space, int count, std::uint64_t seed) {
  if (count < 1) throw UserError("count: expected a number above 0");
  std::vector<PrimarySample> found;
  {
    const py::gil_scoped_release released;
    constexpr int kSamplesPerPath = 1000;  // at most, where the technique seldom finds light
    BidirectionalSampler sampler(space.technique().length());
    const auto wanted = at(count);
    for (std::uint64_t i = 0; found.size() < wanted && i < kSamplesPerPath * wanted; ++i) {
      Random random(seed, kStream, i);
      sampler.sample(space.scene(), random, -1, -1, space.technique().length(),
                     [&](const BidirectionalSampler::Connection& c) {
                       if (c.technique == space.technique())
                         found.push_back(sampler.primarySample(c.technique));
                     });
    }
  }
  Doubles x({static_cast<py::ssize_t>(found.size()), static_cast<py::ssize_t>(space.columns())});
  for (std::size_t i = 0; i < found.size(); ++i)
    space.setRow(found[i], x.mutable_data() + i * at(space.columns()));
  return x;
}

Doubles convert(const PrimarySpace& from, const Doubles& x, const PrimarySpace& to,
                std::uint64_t seed, int threads) {
  from.check(x);
  if (from.scenePtr() != to.scenePtr() || from.technique().length() != to.technique().length())
    throw UserError("expected a technique of the same scene, for paths of as many edges");
  auto result = filled<double>({x.shape(0), to.columns()}, kNaN);
  double* const rows = result.mutable_data();
  from.forPaths(x, threads, [&](int i, const Path& path) {
    Random random(seed, kStream, static_cast<std::uint64_t>(i));
    FullPath full;
    Path other(to.technique().length());
    if (toFull(to.scene(), path, full) &&
        assemble(to.scene(), full, to.technique(), kNoEdge, random, other))
      to.setRow(other.sample, rows + static_cast<py::ssize_t>(i) * to.columns());
  });
  return result;
}

// A path that was traced; what is discrete about it is held fixed as its continuous coordinates move.
class TracedPath {
 public:
  TracedPath(const PrimarySpace& space, Path path) : space_(space), path_(std::move(path)) {}

  const Path& path() const { return path_; }

  Doubles coordinates() const {
    std::vector<double> row(at(space_.columns()));
    space_.setRow(path_.sample, row.data());
    return Doubles(space_.dimension(), row.data());
  }
  double logTarget(const Doubles& x) const {
    double u[kMaxCoordinates];
    dependent(x, u);
    return replayInDouble(space_.scene(), path_, u);
  }
  std::pair<Doubles, Doubles> derivatives(const Doubles& x) const {
    double u[kMaxCoordinates];
    dependent(x, u);
    const ad::DerivativeValues r = differentiateInDouble(space_.scene(), path_, u);
    const py::ssize_t d = space_.dimension();
    Doubles gradient(d), hessian({d, d});
    spread(space_, path_, r.gradient.data(), r.hessian.data(), gradient.mutable_data(),
           hessian.mutable_data());
    return {std::move(gradient), std::move(hessian)};
  }
  Doubles vertices() const {
    FullPath full;
    toFull(space_.scene(), path_, full);
    auto points = filled<double>({full.edges + 1, 3}, kNaN);
    for (int i = full.infinite ? 1 : 0; i <= full.edges - (full.parallel ? 1 : 0); ++i)
      for (int k = 0; k < 3; ++k)
        points.mutable_at(i, k) = full.x[at(i)].point.p[k] + space_.scene().origin[k];
    return points;
  }

 private:
  // The coordinates that the path depends on.
  void dependent(const Doubles& x, double* u) const {
    if (x.ndim() != 1 || x.shape(0) != space_.dimension())
      throw UserError(fmt::format("expected an array of {} coordinates", space_.dimension()));
    for (int i = 0; i < path_.dimension(); ++i) u[i] = x.data()[space_.column(path_, i)];
  }

  PrimarySpace space_;
  Path path_;
};

std::optional<TracedPath> trace(const PrimarySpace& space, Doubles row) {
  if (row.ndim() != 1)
    throw UserError(fmt::format("expected one row of {} coordinates", space.columns()));
  const Doubles rows = row.reshape({py::ssize_t(1), row.shape(0)});
  space.check(rows);
  Path path(space.technique().length());
  path.technique = space.technique();
  path.sample = space.sample(row.data());
  if (!tracePath(space.scene(), path)) return std::nullopt;
  return TracedPath(space, std::move(path));
}

void addPath(py::module_& module) {
  py::class_<TracedPath>(module, "Path",
                         "A path that carries light. Its derivatives are on its frozen topology: "
                         "triangles, lobes, light and visibility stay as they were traced.")
      .def_property_readonly(
          "s", [](const TracedPath& p) { return p.path().technique.s; }, "vertices from the light")
      .def_property_readonly(
          "t", [](const TracedPath& p) { return p.path().technique.t; },
          "vertices from the camera, the eye among them")
      .def_property_readonly(
          "target", [](const TracedPath& p) { return p.path().target; },
          "luminance of the contribution")
      .def_property_readonly(
          "contribution",
          [](const TracedPath& p) {
            const Rgbf& c = p.path().contribution;
            return py::make_tuple(c.x, c.y, c.z);
          },
          "RGB, MIS weighted, over the density of the primary sample")
      .def_property_readonly(
          "film",
          [](const TracedPath& p) { return py::make_tuple(p.path().filmX, p.path().filmY); },
          "(x, y) in [0, 1), from the image's upper left corner")
      .def_property_readonly(
          "moving", [](const TracedPath& p) { return p.path().moving; },
          "whether it depends on time")
      .def_property_readonly("x", &TracedPath::coordinates,
                             "the continuous coordinates that it was traced at, float64 (d,)")
      .def_property_readonly(
          "vertices", &TracedPath::vertices,
          "points in the scene's units, float64 (edges + 1, 3), from the light to the eye; NaN for "
          "an infinite light and the eye of an orthographic camera")
      .def("log_target", &TracedPath::logTarget, py::arg("x"),
           "log(target) at continuous coordinates x (d,), in double")
      .def(
          "gradient", [](const TracedPath& p, const Doubles& x) { return p.derivatives(x).first; },
          py::arg("x"), "of log_target, by automatic differentiation in double: (d,)")
      .def(
          "hessian", [](const TracedPath& p, const Doubles& x) { return p.derivatives(x).second; },
          py::arg("x"), "of log_target, by automatic differentiation in double: (d, d)");
}

}  // namespace

void addTechnique(py::module_& module, SceneClass& scene) {
  addPath(module);
  const auto threads = py::arg("threads") = 0;
  py::class_<PrimarySpace>(
      module, "Technique",
      "A bidirectional technique: s vertices from the light and t from the camera, the eye among "
      "them. Its paths are rows of an array: d continuous coordinates, then choices, all in [0, "
      "1).")
      .def_property_readonly(
          "s", [](const PrimarySpace& p) { return p.technique().s; }, "vertices from the light")
      .def_property_readonly(
          "t", [](const PrimarySpace& p) { return p.technique().t; },
          "vertices from the camera, the eye among them")
      .def_property_readonly(
          "edges", [](const PrimarySpace& p) { return p.technique().length(); },
          "of its paths: s + t - 1")
      .def_property_readonly("dimension", &PrimarySpace::dimension,
                             "d, the number of continuous coordinates")
      .def_property_readonly("names", &PrimarySpace::names, "of the columns")
      .def("sample", &samplePaths, py::arg("count"), py::arg("seed") = 0,
           "Up to `count` paths that carry light, connections of bidirectional samples: float64 "
           "(n, columns). Fewer where the technique hardly finds any.")
      .def(
          "evaluate", &evaluate, py::arg("x"), threads,
          "The paths of the rows of x, traced: a dict of `contribution` (n, 3), `target` (n,), its "
          "luminance, and `film` (n, 2); zeros where a path carries no light.")
      .def(
          "differentiate", &differentiateRows, py::arg("x"), py::arg("dtype") = "float32", threads,
          "(log target (n,), gradient (n, d), Hessian (n, d, d)) with respect to the continuous "
          "coordinates, topology frozen. float32 is what renders; float64 is to check it. -inf and "
          "NaN where a path carries no light.")
      .def("convert", &convert, py::arg("x"), py::arg("to"), py::arg("seed") = 0, threads,
           "The same paths as another technique of as many edges makes them: rows for `to`. What "
           "its choices leave open is drawn. NaN where it can't make a path.")
      .def("trace", &trace, py::arg("row"),
           "The path of one row, an h2mc.Path, or None where it carries no light.")
      .def("__repr__", [](const PrimarySpace& p) {
        return fmt::format("<h2mc.Technique s={} t={}: {} coordinates, {} choices>",
                           p.technique().s, p.technique().t, p.dimension(),
                           p.technique().choices());
      });
  scene.def(
      "technique",
      [](const ScenePtr& s, int vertices, int t) { return PrimarySpace(s, vertices, t); },
      py::arg("s"), py::arg("t"), "The technique (s, t) on this scene.");
}

}  // namespace h2mc::python
