// SPDX-License-Identifier: MIT
// Images in Python: files and metrics.
#include <algorithm>

#include "python/module.h"
#include "render/image/image_io.h"
#include "render/image/metrics.h"

namespace h2mc::python {
namespace {

static_assert(sizeof(Rgbf) == 3 * sizeof(float));

py::dict compareImages(const Array<float>& image, const Array<float>& reference) {
  const Image a = toImage(image), r = toImage(reference);
  if (a.width != r.width || a.height != r.height)
    throw UserError("the images differ in size: " + std::to_string(a.width) + " x " +
                    std::to_string(a.height) + " and " + std::to_string(r.width) + " x " +
                    std::to_string(r.height) + " pixels");
  py::dict values;
  for (const Metric& metric : metrics())
    values[py::str(std::string(metric.name))] = metric.compute(a, r);
  return values;
}

}  // namespace

py::array_t<float> toArray(const Image& image) {
  py::array_t<float> array({image.height, image.width, 3});
  const auto* first = reinterpret_cast<const float*>(image.pixels.data());
  std::copy_n(first, array.size(), array.mutable_data());
  return array;
}

Image toImage(const Array<float>& array) {
  if (array.ndim() != 3 || array.shape(2) != 3 || array.size() == 0)
    throw UserError("expected an image, an array of shape (height, width, 3)");
  Image image(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
  std::copy_n(array.data(), array.size(), reinterpret_cast<float*>(image.pixels.data()));
  return image;
}

void addImages(py::module_& module) {
  module.def(
      "read_image", [](const std::string& file) { return toArray(readImage(file)); },
      py::arg("file"), "Reads a picture (EXR, HDR, PNG, JPEG, ...) as linear RGB.");
  module.def(
      "write_image",
      [](const std::string& file, const Array<float>& image) { writeImage(file, toImage(image)); },
      py::arg("file"), py::arg("image"),
      "Writes .exr (32-bit float), .hdr or .png (sRGB, 8 bit), by the file's ending. A file that "
      "is "
      "there is replaced once all is written.");
  module.def(
      "metrics", &compareImages, py::arg("image"), py::arg("reference"),
      "How far an image is from a reference, by all metrics of `h2mc diff`: a dict of numbers.");
}

}  // namespace h2mc::python
