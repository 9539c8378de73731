// SPDX-License-Identifier: MIT
// A comparison's files for papers: figures, and LaTeX that holds them.
#pragma once

#include <string>
#include <vector>

#include "compare/results.h"
#include "render/image/image.h"

namespace h2mc {

struct PaperFile {
  std::string name;  // relative to the comparison's folder
  std::string bytes;
};

// results.tex, figures.tex and paper.tex; and below figures/, for each scene, error curves against time and work and a
// strip of pictures at equal time (or work), each as SVG and PDF, where this build can draw. Reads the images. Throws
// ImageError, and std::runtime_error where the figures can't be drawn.
std::vector<PaperFile> paperFiles(const std::vector<SceneResults>& results,
                                  const ComparisonPlan& plan, const std::vector<Image>& references);

}  // namespace h2mc
