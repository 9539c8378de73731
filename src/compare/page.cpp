// SPDX-License-Identifier: MIT
#include "compare/page.h"

#include <algorithm>
#include <cmath>

#include "compare/embed.h"
#include "compare/page_files.h"
#include "render/image/image_io.h"

namespace h2mc {
namespace {

using nlohmann::json;

// Values times 2^-exponent are stored: the largest is just below the largest half, so that dark
// pictures do not fall among the denormal numbers.
json imageJson(const Image& image) {
  float largest = 0;
  for (const Rgbf& p : image.pixels)
    for (int c = 0; c < 3; ++c)
      if (std::isfinite(p[c])) largest = std::max(largest, std::abs(p[c]));
  const int exponent = largest > 0 ? std::ilogb(largest) - 14 : 0;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(image.pixels.size() * 6);
  for (const Rgbf& p : image.pixels)
    for (int c = 0; c < 3; ++c) {
      const std::uint16_t half = halfBits(std::ldexp(p[c], -exponent));
      bytes.push_back(static_cast<std::uint8_t>(half & 255));
      bytes.push_back(static_cast<std::uint8_t>(half >> 8));
    }
  return {{"exponent", exponent}, {"data", base64(bytes)}};
}

}  // namespace

std::string comparisonPage(const std::vector<SceneResults>& results, const ComparisonPlan& plan,
                           const std::vector<Image>& references, EmbeddedImages images) {
  json data = resultsJson(results, plan);
  for (std::size_t s = 0; s < results.size(); ++s) {
    json& scene = data["scenes"][s];
    if (images != EmbeddedImages::kNone) scene["reference"]["pixels"] = imageJson(references[s]);
    for (std::size_t m = 0; m < results[s].runs.methods.size(); ++m) {
      const MethodRuns& method = results[s].runs.methods[m];
      json& repeats = scene["methods"][m]["repeats"];
      // The page shows numbers of all repeats, but the statistics of none.
      for (json& repeat : repeats)
        for (json& point : repeat["points"]) point.erase("statistics");
      if (images == EmbeddedImages::kNone || method.repeats.empty()) continue;
      const Point* last = shownPoint(method, plan.marks.back(), plan.timed);
      for (std::size_t k = 0; k < method.repeats.front().points.size(); ++k) {
        const Point& point = method.repeats.front().points[k];
        if (images == EmbeddedImages::kLast && &point != last) continue;
        repeats[0]["points"][k]["pixels"] = imageJson(readImage(point.image.string()));
      }
    }
  }
  return filledPage(page::kHtml, page::kStyle, page::kScript, data);
}

}  // namespace h2mc
