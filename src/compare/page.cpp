// SPDX-License-Identifier: MIT
#include "compare/page.h"

#include "compare/embed.h"
#include "compare/insets.h"
#include "compare/page_files.h"
#include "render/image/image_io.h"

namespace h2mc {

using nlohmann::json;

std::string comparisonPage(const std::vector<SceneResults>& results, const ComparisonPlan& plan,
                           const std::vector<Image>& references, EmbeddedImages images) {
  json data = resultsJson(results, plan);
  for (std::size_t s = 0; s < results.size(); ++s) {
    json& scene = data["scenes"][s];
    if (images != EmbeddedImages::kNone)
      scene["reference"]["pixels"] = embeddedPixels(references[s]);
    std::vector<Image> compared;
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
        Image image = readImage(point.image.string());
        repeats[0]["points"][k]["pixels"] = embeddedPixels(image);
        if (&point == last) compared.push_back(std::move(image));
      }
    }
    scene["insets"] = json::array();
    for (const PixelRectangle& r : whereTheyDiffer(compared, references[s], kInsets))
      scene["insets"].push_back({{"x", r.x}, {"y", r.y}, {"width", r.width}, {"height", r.height}});
  }
  return filledPage(page::kHtml, page::kStyle, page::kScript, data);
}

}  // namespace h2mc
