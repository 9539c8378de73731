// SPDX-License-Identifier: MIT
// Drawings as files, by a module that is loaded when one is asked for: cairo brings thirty libraries with it. A build
// without cairo has no module.
#pragma once

#include <string>

#include "compare/figure.h"

namespace h2mc {

enum class FigureFormat { kSvg, kPdf };

// Whether this build can make them.
bool canDrawFigures();

// The file's bytes. Throws std::runtime_error: why not. Precondition: canDrawFigures().
std::string figureFile(const Figure& figure, FigureFormat format);

// What the module defines under this name.
extern "C" void h2mcFigureFile(const Figure& figure, FigureFormat format, std::string& bytes);

}  // namespace h2mc
