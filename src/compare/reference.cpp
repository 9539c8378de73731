// SPDX-License-Identifier: MIT
#include "compare/reference.h"

#include <fmt/format.h>

#include <cmath>

#include "render/image/image_io.h"
#include "render/image/metrics.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;

// 1 where the size fits, the factor where `image` is a whole multiple of it.
int factorTo(const Image& image, int width, int height) {
  if (image.width % width != 0 || image.height % height != 0) return 0;
  const int factor = image.width / width;
  return image.height / height == factor ? factor : 0;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

std::string referenceFile(const ComparisonPlan& plan, const ComparedScene& scene) {
  return replaced(plan.reference, "{scene}", scene.name);
}

}  // namespace

std::optional<glm::ivec2> sizeForReference(const ComparisonPlan& plan, const ComparedScene& scene,
                                           int width, int height) {
  if (plan.reference == "auto" || plan.width > 0 || plan.height > 0 || plan.scale > 0) return {};
  const Image image = readImage(referenceFile(plan, scene));
  if (factorTo(image, width, height) > 0) return {};
  const auto across = [](int a, int b) { return static_cast<long long>(a) * b; };
  if (across(image.width, height) != across(image.height, width)) return {};
  return glm::ivec2(image.width, image.height);
}

Reference givenReference(const ComparisonPlan& plan, const ComparedScene& scene, int width,
                         int height) {
  const std::string file = referenceFile(plan, scene);
  Reference result;
  result.image = readImage(file);
  const int factor = factorTo(result.image, width, height);
  if (factor == 0)
    throw ComparisonError(fmt::format(
        "the reference \"{}\" is {} x {}, the images of {} are {} x {}: it has to be as "
        "large or a whole multiple; --width, --height and --scale set the images' size",
        file, result.image.width, result.image.height, scene.name, width, height));
  if (factor > 1) result.image = averaged(result.image, factor);
  if (countNonFinite(result.image) > 0)
    throw ComparisonError("the reference \"" + file + "\" has pixels that are not finite");
  result.facts.file = file;
  result.facts.origin = "given";
  if (factor > 1) result.facts.origin += fmt::format(", averaged over {0} x {0} pixels", factor);

  const fs::path path(file);
  const fs::path errors =
      path.parent_path() / (path.stem().string() + "_stderr" + path.extension().string());
  if (fs::exists(errors)) {
    // The image that is one standard error away has the reference's own expected error.
    Image off = readImage(errors.string());
    if (factorTo(off, width, height) == factor) {
      for (Rgbf& e : off.pixels) e = e * e;
      if (factor > 1) off = averaged(off, factor);
      const float scale = 1.f / static_cast<float>(factor);
      double variance = 0;  // of the sum of luminances, pixels taken as independent
      for (std::size_t i = 0; i < off.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) off.pixels[i][c] = scale * std::sqrt(off.pixels[i][c]);
        variance += squared(static_cast<double>(luminance(off.pixels[i])));
        off.pixels[i] += result.image.pixels[i];
      }
      const double sum =
          meanLuminance(result.image) * static_cast<double>(result.image.pixels.size());
      if (sum > 0) result.facts.brightness = std::sqrt(variance) / sum;
      result.facts.error = findMetric("relmse")->compute(off, result.image);
      result.facts.origin += ", its error by " + errors.filename().string();
    }
  }
  return result;
}

}  // namespace h2mc
