// SPDX-License-Identifier: MIT
// The Python module h2mc.
#include "python/module.h"

#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

#include "h2mc_version.h"
#include "render/core/user_error.h"

namespace h2mc::python {

py::object toPython(const nlohmann::json& value) {
  return py::module_::import("json").attr("loads")(value.dump());
}

}  // namespace h2mc::python

PYBIND11_MODULE(h2mc, module) {
  using namespace h2mc::python;
  module.doc() =
      "Metropolis light transport steered by derivatives.\n\n"
      "    scene = h2mc.load('scene.xml')\n"
      "    image, statistics = scene.render(time=10)\n\n"
      "Images are float32 arrays of shape (height, width, 3), linear Rec. 709 RGB, rows from the "
      "top.";
  module.attr("__version__") = H2MC_VERSION_STRING;
  py::register_exception<h2mc::UserError>(module, "Error", PyExc_ValueError).attr("__doc__") =
      "What is wrong with a scene, an option, a file: the message that the program prints.";
  SceneClass scene = addScene(module);
  addRender(scene);
  addPath(module);
  addTechnique(module, scene);
  addChain(module, scene);
  addImages(module);
  // Warnings are in Scene.warnings.
  spdlog::set_level(spdlog::level::err);
}
