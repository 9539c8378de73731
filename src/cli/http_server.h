// SPDX-License-Identifier: MIT
// A server for this machine alone, in a module that is loaded when one is asked for: its library brings those for
// encryption and compression with it. A build without the library has no module.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace h2mc {

struct HttpRequest {
  std::string method, path;
  std::string seen;    // the parameter of this name
  std::string token;   // the header X-H2mc, which a page of another origin can't send
  bool local = false;  // whether it was asked for as localhost or 127.0.0.1
};
struct HttpAnswer {
  int status = 200;
  std::string type, body;
};
// Called from several threads.
using HttpHandler = std::function<HttpAnswer(const HttpRequest&)>;

// Serves until it is destroyed.
class HttpServer {
 public:
  virtual ~HttpServer() = default;
  virtual int port() const = 0;
};

// Listens on 127.0.0.1. port: 0 for any that is free. Throws std::runtime_error: why not.
std::unique_ptr<HttpServer> serveLocally(int port, HttpHandler handler);

// What the module defines under this name.
extern "C" HttpServer* h2mcServeLocally(int port, HttpHandler* handler);

}  // namespace h2mc
