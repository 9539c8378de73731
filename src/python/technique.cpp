// SPDX-License-Identifier: MIT
// Paths in Python: the target on a technique's primary space, its derivatives, and single paths.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "python/traced_path.h"
#include "render/path/assemble.h"
#include "render/path/bidirectional.h"
#include "render/path/derivative.h"
#include "render/path/replay_double.h"

namespace h2mc::python {
namespace {

constexpr std::uint64_t kStream = 0x7079;

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

}  // namespace

void addTechnique(py::module_& module, SceneClass& scene) {
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
