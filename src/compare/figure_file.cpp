// SPDX-License-Identifier: MIT
#include "compare/figure_file.h"

#ifdef H2MC_FIGURES_MODULE
#include <dlfcn.h>
#endif

#include <stdexcept>

namespace h2mc {

#ifdef H2MC_FIGURES_MODULE

bool canDrawFigures() { return true; }

std::string figureFile(const Figure& figure, FigureFormat format) {
  // Looked for as image_formats.cpp does.
  static void* const entry = [] {
    void* const module = dlopen(H2MC_FIGURES_MODULE, RTLD_NOW | RTLD_LOCAL);
    void* const found = module ? dlsym(module, "h2mcFigureFile") : nullptr;
    if (!found)
      throw std::runtime_error(std::string("the module for figures does not load: ") + dlerror());
    return found;
  }();
  std::string bytes;
  reinterpret_cast<decltype(&h2mcFigureFile)>(entry)(figure, format, bytes);
  return bytes;
}

#else

bool canDrawFigures() { return false; }

std::string figureFile(const Figure&, FigureFormat) {
  throw std::runtime_error("this build draws no figures: it was made without cairo");
}

#endif

}  // namespace h2mc
