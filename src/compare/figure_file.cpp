// SPDX-License-Identifier: MIT
#include "compare/figure_file.h"

#ifdef H2MC_FIGURES_MODULE
#include <dlfcn.h>
#endif

#include <stdexcept>

namespace h2mc {

#ifdef H2MC_FIGURES_MODULE

namespace {

void* entry(const char* name) {
  // Looked for as image_formats.cpp does.
  static void* const module = dlopen(H2MC_FIGURES_MODULE, RTLD_NOW | RTLD_LOCAL);
  void* const found = module ? dlsym(module, name) : nullptr;
  if (!found) {
    const char* const why = dlerror();  // told once
    throw std::runtime_error(std::string("the module for figures does not load") +
                             (why ? std::string(": ") + why : std::string()));
  }
  return found;
}

}  // namespace

bool canDrawFigures() { return true; }

std::string figureFile(const Figure& figure, FigureFormat format) {
  std::string bytes;
  reinterpret_cast<decltype(&h2mcFigureFile)>(entry("h2mcFigureFile"))(figure, format, bytes);
  return bytes;
}

TextMask textMask(const std::string& text, double size) {
  TextMask mask;
  reinterpret_cast<decltype(&h2mcTextMask)>(entry("h2mcTextMask"))(text, size, mask);
  return mask;
}

#else

bool canDrawFigures() { return false; }

std::string figureFile(const Figure&, FigureFormat) {
  throw std::runtime_error("this build draws no figures: it was made without cairo");
}

TextMask textMask(const std::string&, double) {
  throw std::runtime_error("this build has no fonts: it was made without cairo");
}

#endif

}  // namespace h2mc
