// SPDX-License-Identifier: MIT
#include "render/image/image_formats.h"

#include <dlfcn.h>

#include <stdexcept>

namespace h2mc {

const ImageFormats& imageFormats() {
  // Looked for in the program's RPATH: the build's folder, or lib/h2mc beside the installed program's.
  static const ImageFormats* const formats = [] {
    void* const module = dlopen(H2MC_OIIO_MODULE, RTLD_NOW | RTLD_LOCAL);
    void* const entry = module ? dlsym(module, "h2mcImageFormats") : nullptr;
    if (!entry)
      throw std::runtime_error(std::string("the module for image files does not load: ") +
                               dlerror());
    return reinterpret_cast<decltype(&h2mcImageFormats)>(entry)();
  }();
  return *formats;
}

}  // namespace h2mc
