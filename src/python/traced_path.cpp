// SPDX-License-Identifier: MIT
#include "python/traced_path.h"

#include <fmt/format.h>

#include "render/path/full_path.h"
#include "render/path/replay_double.h"

namespace h2mc::python {

Doubles TracedPath::coordinates() const {
  std::vector<double> row(at(space_.columns()));
  space_.setRow(path_.sample, row.data());
  return Doubles(space_.dimension(), row.data());
}

double TracedPath::logTarget(const Doubles& x) const {
  double u[kMaxCoordinates];
  dependent(x, u);
  return replayInDouble(space_.scene(), path_, u);
}

std::pair<Doubles, Doubles> TracedPath::derivatives(const Doubles& x) const {
  double u[kMaxCoordinates];
  dependent(x, u);
  const ad::DerivativeValues r = differentiateInDouble(space_.scene(), path_, u);
  const py::ssize_t d = space_.dimension();
  Doubles gradient(d), hessian({d, d});
  spread(space_, path_, r.gradient.data(), r.hessian.data(), gradient.mutable_data(),
         hessian.mutable_data());
  return {std::move(gradient), std::move(hessian)};
}

Doubles TracedPath::vertices() const {
  FullPath full;
  toFull(space_.scene(), path_, full);
  auto points = filled<double>({full.edges + 1, 3}, kNaN);
  for (int i = full.infinite ? 1 : 0; i <= full.edges - (full.parallel ? 1 : 0); ++i)
    for (int k = 0; k < 3; ++k)
      points.mutable_at(i, k) = full.x[at(i)].point.p[k] + space_.scene().origin[k];
  return points;
}

void TracedPath::dependent(const Doubles& x, double* u) const {
  if (x.ndim() != 1 || x.shape(0) != space_.dimension())
    throw UserError(fmt::format("expected an array of {} coordinates", space_.dimension()));
  for (int i = 0; i < path_.dimension(); ++i) u[i] = x.data()[space_.column(path_, i)];
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

}  // namespace h2mc::python
