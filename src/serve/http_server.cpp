// SPDX-License-Identifier: MIT
// The module that serveLocally() loads.
#include "cli/http_server.h"

#include <httplib.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

namespace h2mc {
namespace {

constexpr const char* kAddress = "127.0.0.1";
constexpr int kThreads =
    16;  // browsers hold connections that they ask nothing by, each of which has one
constexpr int kSeconds = 2;  // for one who asks nothing, or does not read what it has asked for

// The name by which it was asked for, whatever the port: a tunnel may end at another one. Not that of a page whose
// name has been made to mean this machine.
bool isLocalName(std::string_view host) {
  host = host.substr(0, host.rfind(':'));
  return host == kAddress || host == "localhost";
}

class LocalServer final : public HttpServer {
 public:
  LocalServer(int port, HttpHandler handler) : handler_(std::move(handler)) {
    server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    // A port that another render serves on is not shared with it, as the library would have it.
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.set_keep_alive_max_count(1);
    server_.set_keep_alive_timeout(kSeconds);
    server_.set_read_timeout(kSeconds);
    server_.set_write_timeout(kSeconds);
    server_.set_payload_max_length(1024);
    server_.set_default_headers(
        {{"Cache-Control", "no-store"},
         {"X-Content-Type-Options", "nosniff"},
         {"Content-Security-Policy",
          "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
          "connect-src 'self'; frame-ancestors 'none'"}});
    const auto answer = [this](const httplib::Request& request, httplib::Response& response) {
      const HttpAnswer answer = handler_(
          {request.method, request.path, request.get_param_value("seen"),
           request.get_header_value("X-H2mc"), isLocalName(request.get_header_value("Host"))});
      response.status = answer.status;
      // Content as such would be compressed as well as can be, which takes seconds for a picture.
      response.set_content_provider(
          answer.body.size(), answer.type,
          [body = std::move(answer.body)](std::size_t offset, std::size_t length,
                                          httplib::DataSink& sink) {
            return sink.write(body.data() + offset, length);
          });
    };
    server_.Get(".*", answer);
    server_.Post(".*", answer);
    port_ = port > 0 ? (server_.bind_to_port(kAddress, port) ? port : -1)
                     : server_.bind_to_any_port(kAddress);
    if (port_ < 0) throw std::runtime_error(std::strerror(errno));
    thread_ = std::thread([this] {
      server_.listen_after_bind();
      ended_ = true;
    });
  }
  ~LocalServer() override {
    // One that has not begun can't be stopped.
    while (!server_.is_running() && !ended_)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    server_.stop();
    thread_.join();
  }
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  int port() const override { return port_; }

 private:
  HttpHandler handler_;
  httplib::Server server_;
  int port_ = -1;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace

extern "C" HttpServer* h2mcServeLocally(int port, HttpHandler* handler) {
  return new LocalServer(port, std::move(*handler));
}

}  // namespace h2mc
