// SPDX-License-Identifier: MIT
// The parts of the Python module, each in a file of its own.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <nlohmann/json_fwd.hpp>

#include "render/image/image.h"
#include "render/scene/scene.h"

namespace h2mc::python {

namespace py = pybind11;

// Python keeps scenes alive for as long as anything refers to them.
using ScenePtr = std::shared_ptr<Scene>;
using SceneClass = py::class_<Scene, ScenePtr>;

// Row-major, converted to where need be.
template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

SceneClass addScene(py::module_& module);
void addRender(SceneClass& scene);
void addPath(py::module_& module);
void addTechnique(py::module_& module, SceneClass& scene);
void addChain(py::module_& module, SceneClass& scene);
void addImages(py::module_& module);

// Of shape (height, width, 3), float32, linear RGB.
py::array_t<float> toArray(const Image& image);
Image toImage(const Array<float>& array);

// As json.loads() makes it.
py::object toPython(const nlohmann::json& value);

}  // namespace h2mc::python
