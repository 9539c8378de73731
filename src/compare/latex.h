// SPDX-License-Identifier: MIT
// A comparison's results in LaTeX, for papers.
#pragma once

#include <string>
#include <vector>

#include "compare/curves.h"
#include "compare/results.h"

namespace h2mc {

// A table for the main metric: scenes in groups, a row for each method. Needs booktabs.
std::string latexTable(const std::vector<SceneResults>& results, const ComparisonPlan& plan);

// One figure of a scene, in a file.
struct PaperFigure {
  enum class Kind { kTime, kWork, kStrip };
  std::size_t scene;
  Kind kind;
  std::string file;  // without its ending, relative to the comparison's folder
};

// The figures with captions that say what is seen, how often it was repeated, and on what. Needs graphicx.
std::string latexFigures(const std::vector<PaperFigure>& figures,
                         const std::vector<SceneResults>& results, const ComparisonPlan& plan);

// A document with table and figures, to be compiled beside them.
std::string latexDocument(bool withFigures);

}  // namespace h2mc
