// SPDX-License-Identifier: MIT
#include "compare/paper.h"

#include <utility>

#include "compare/curve_figure.h"
#include "compare/figure_file.h"
#include "compare/insets.h"
#include "compare/latex.h"
#include "compare/strip_figure.h"
#include "render/image/image_io.h"

namespace h2mc {
namespace {

// Each method's image at the place where they are compared; an empty one where there is none.
std::vector<Image> comparedImages(const SceneResults& scene, const ComparisonPlan& plan) {
  const Summary& summary = mainSummaries(scene, plan).front();
  std::vector<Image> images;
  for (const MethodRuns& method : scene.runs.methods) {
    const Point* point = shownPoint(method, summary.position, summary.timed);
    images.push_back(point ? readImage(point->image.string()) : Image());
  }
  return images;
}

}  // namespace

std::vector<PaperFile> paperFiles(const std::vector<SceneResults>& results,
                                  const ComparisonPlan& plan,
                                  const std::vector<Image>& references) {
  std::vector<PaperFile> files;
  std::vector<PaperFigure> figures;
  const auto add = [&](std::size_t scene, PaperFigure::Kind kind, const char* what,
                       const Figure& figure) {
    const std::string name = "figures/" + fileNameFor(results[scene].runs.scene.name) + "-" + what;
    files.push_back({name + ".svg", figureFile(figure, FigureFormat::kSvg)});
    files.push_back({name + ".pdf", figureFile(figure, FigureFormat::kPdf)});
    figures.push_back({scene, kind, name});
  };
  for (std::size_t s = 0; canDrawFigures() && s < results.size(); ++s) {
    add(s, PaperFigure::Kind::kTime, "time", curveFigure(results[s], true));
    add(s, PaperFigure::Kind::kWork, "work", curveFigure(results[s], false));
    const std::vector<Image> images = comparedImages(results[s], plan);
    std::vector<Image> there;
    for (const Image& image : images)
      if (!image.pixels.empty()) there.push_back(image);
    const auto insets = whereTheyDiffer(there, references[s], kInsets);
    if (!insets.empty())
      add(s, PaperFigure::Kind::kStrip, plan.timed ? "equal-time" : "equal-work",
          stripFigure(results[s], plan, references[s], images, insets));
  }
  files.push_back({"results.tex", latexTable(results, plan)});
  if (!figures.empty()) files.push_back({"figures.tex", latexFigures(figures, results, plan)});
  files.push_back({"paper.tex", latexDocument(!figures.empty())});
  return files;
}

}  // namespace h2mc
