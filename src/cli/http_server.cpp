// SPDX-License-Identifier: MIT
#include "cli/http_server.h"

#ifdef H2MC_SERVE_MODULE
#include <dlfcn.h>
#endif

#include <stdexcept>

namespace h2mc {

#ifdef H2MC_SERVE_MODULE

std::unique_ptr<HttpServer> serveLocally(int port, HttpHandler handler) {
  // Looked for as image_formats.cpp does.
  void* const module = dlopen(H2MC_SERVE_MODULE, RTLD_NOW | RTLD_LOCAL);
  void* const entry = module ? dlsym(module, "h2mcServeLocally") : nullptr;
  if (!entry)
    throw std::runtime_error(std::string("the module that serves pages does not load: ") +
                             dlerror());
  return std::unique_ptr<HttpServer>(
      reinterpret_cast<decltype(&h2mcServeLocally)>(entry)(port, &handler));
}

#else

std::unique_ptr<HttpServer> serveLocally(int, HttpHandler) {
  throw std::runtime_error(
      "this build serves no pages: it was made without cpp-httplib (Debian's libcpp-httplib-dev "
      "and pkg-config)");
}

#endif

}  // namespace h2mc
