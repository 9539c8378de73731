// SPDX-License-Identifier: MIT
// The picture while it is rendered: in a viewer, and on a page.
#pragma once

#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/http_server.h"
#include "cli/viewer_connection.h"
#include "render/integrator/integrator.h"

namespace CLI {
class App;
}

namespace h2mc {

struct LiveOptions {
  std::string display;       // HOST:PORT of a viewer; empty: none
  std::optional<int> serve;  // port of the page; 0: any that is free
};
void addLiveOptions(CLI::App& command, LiveOptions& options);

// Shows a render to whoever looks on. The picture is taken between two rounds, in time that is not counted as the
// render's, and only while somebody waits for it: at most once a second, and for at most a twentieth of the time.
// Nothing that a viewer or a browser does holds up the render.
class LiveView {
 public:
  // image: the name of what is rendered. Throws InputError where the viewer's address is none, or the port can't be
  // had.
  LiveView(const LiveOptions& options, const std::string& image);
  ~LiveView();

  // Whether anything is to be shown at all.
  bool wanted() const { return viewer_ || server_; }
  // Whether the render is to tell its variance too: RenderRequest::pixelStatistics.
  bool wantsVariance() const { return server_ != nullptr; }
  // Where the page is; empty: nowhere.
  std::string address() const;

  // What the page says of the render as a whole: an object of text and numbers.
  void describe(nlohmann::json facts);
  // From RenderRequest::progress and ::watch.
  void progress(const RenderProgress& progress);
  void look(RenderInProgress& render);
  // The render is over and its image written, or not. Waits for a moment until who looks on has the last picture.
  void finish(const RenderResult& result, bool written);

 private:
  struct Shown;
  HttpAnswer answer(const HttpRequest& request);
  HttpAnswer state(const std::string& seen);
  bool somebodyWaits() const;
  void show(const RenderResult& result, bool over, bool written);

  std::unique_ptr<ViewerConnection> viewer_;
  mutable std::mutex mutex_;  // of what follows, but for the server
  std::string page_;
  std::shared_ptr<const Shown> shown_;
  RenderProgress progress_{};
  double asked_;                        // when the page was last asked for news
  long long taken_ = 0;                 // the number of the last picture that a page has got
  double last_;                         // when a picture was last taken
  double cost_ = 0;                     // seconds that took
  std::unique_ptr<HttpServer> server_;  // last, so that it ends first
};

}  // namespace h2mc
