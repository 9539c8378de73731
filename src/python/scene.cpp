// SPDX-License-Identifier: MIT
// Scenes in Python.
#include "mcmc/render/integrators.h"
#include "python/module.h"
#include "render/scene/scene_reader.h"

namespace h2mc::python {
namespace {

ReadOptions readOptions(int width, int height, double scale,
                        const std::map<std::string, std::string>& defines, bool permissive,
                        const std::vector<IntegratorPlugin>& integrators) {
  if (width < 0 || height < 0 || scale < 0)
    throw UserError("width, height and scale: expected numbers above 0, or 0 for the scene's own");
  ReadOptions options;
  options.width = width;
  options.height = height;
  options.scale = scale;
  options.defines = defines;
  options.integrators = integrators;
  options.strictness = permissive ? Strictness::kPermissive : Strictness::kByVersion;
  return options;
}

ScenePtr load(const std::string& file, int width, int height, double scale,
              const std::map<std::string, std::string>& defines, bool permissive) {
  const py::gil_scoped_release released;
  const std::vector<IntegratorPlugin> integrators = integratorPlugins();
  return std::make_shared<Scene>(
      readScene(file, readOptions(width, height, scale, defines, permissive, integrators)));
}

ScenePtr loadString(const std::string& text, const std::string& folder, int width, int height,
                    double scale, const std::map<std::string, std::string>& defines,
                    bool permissive) {
  const py::gil_scoped_release released;
  const std::vector<IntegratorPlugin> integrators = integratorPlugins();
  const std::string name = (folder.empty() ? "" : folder + "/") + "<string>";
  return std::make_shared<Scene>(readSceneText(
      text, name, readOptions(width, height, scale, defines, permissive, integrators)));
}

}  // namespace

SceneClass addScene(py::module_& module) {
  const auto defines = py::arg("defines") = std::map<std::string, std::string>();
  module.def(
      "load", &load, py::arg("file"), py::kw_only(), py::arg("width") = 0, py::arg("height") = 0,
      py::arg("scale") = 0, defines, py::arg("permissive") = false,
      "Reads a scene file (Mitsuba XML). width, height: of the image in pixels, one alone keeps "
      "the aspect ratio; scale: a factor on both. defines: values of the scene's $names. "
      "Raises h2mc.Error with all that is wrong.");
  module.def(
      "load_string", &loadString, py::arg("text"), py::arg("folder") = "", py::kw_only(),
      py::arg("width") = 0, py::arg("height") = 0, py::arg("scale") = 0, defines,
      py::arg("permissive") = false,
      "The same of a scene in a string; files that it refers to are looked for in `folder`.");
  SceneClass scene(module, "Scene", "A scene that has been read; it does not change.");
  scene
      .def_property_readonly(
          "width", [](const Scene& s) { return s.film.width; }, "pixels")
      .def_property_readonly(
          "height", [](const Scene& s) { return s.film.height; }, "pixels")
      .def_property_readonly(
          "moving", [](const Scene& s) { return s.moving; },
          "whether anything moves while the shutter is open: paths have a coordinate `time`")
      .def_property_readonly(
          "aperture", [](const Scene& s) { return s.camera.hasAperture(); },
          "whether the camera has a lens: paths have two coordinates `aperture0`, `aperture1`")
      .def_property_readonly(
          "warnings", [](const Scene& s) { return s.warnings; },
          "what is likely a mistake, or not rendered as the scene asks for: list of messages")
      .def_property_readonly(
          "notes", [](const Scene& s) { return s.notes; }, "what was accepted and not used")
      .def("__repr__", [](const Scene& s) {
        return "<h2mc.Scene of " + std::to_string(s.film.width) + " x " +
               std::to_string(s.film.height) + " pixels, " + std::to_string(s.shapes.size()) +
               " shapes, " + std::to_string(s.lights.size()) + " lights>";
      });
  return scene;
}

}  // namespace h2mc::python
