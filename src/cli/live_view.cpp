// SPDX-License-Identifier: MIT
#include "cli/live_view.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/live_page_files.h"
#include "cli/stop_signals.h"
#include "compare/embed.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

using nlohmann::json;

constexpr double kLeastBetween = 1;  // seconds from one picture to the next
constexpr double kShareOfTime = 20;  // pictures take at most one of so many seconds
constexpr double kStillThere = 5;    // seconds after which who asks no more has gone
constexpr double kLastNews = 2;      // seconds that a page has for the last picture

// Of the pixels' luminance.
std::vector<float> standardErrors(const Image& variance) {
  std::vector<float> errors;
  errors.reserve(variance.pixels.size());
  // The channels of what is one path go up and down together.
  for (const Rgbf& v : variance.pixels)
    errors.push_back(luminance(Rgbf(std::sqrt(v.x), std::sqrt(v.y), std::sqrt(v.z))));
  return errors;
}

json acceptanceOf(const json& statistics) {
  json kinds = json::array();
  if (!statistics.is_object() || !statistics.contains("mutation kinds")) return kinds;
  for (const auto& [name, kind] : statistics["mutation kinds"].items())
    kinds.push_back({{"name", name},
                     {"proposed", kind.value("proposed", 0LL)},
                     {"acceptance", kind.value("acceptance", 0.0)}});
  return kinds;
}

constexpr const char* kNotYet =
    "<!doctype html><title>h2mc</title><meta http-equiv=\"refresh\" content=\"1\">"
    "The scene is being read.";

// Numbers that are not finite are no JSON.
json finite(double value) { return std::isfinite(value) ? json(value) : json(); }

}  // namespace

// One look at the render.
struct LiveView::Shown {
  long long number = 0;
  json state;            // without the pixels
  std::string pictures;  // the pixels, as JSON
};

void addLiveOptions(CLI::App& command, LiveOptions& options) {
  command
      .add_option("--display", options.display,
                  "HOST:PORT of a viewer that speaks tev's protocol (tev listens at "
                  "127.0.0.1:14158): shows the picture while it is rendered")
      ->type_name("HOST:PORT");
  command
      .add_option("--serve", options.serve,
                  "PORT: a page for this machine's browser, with the picture so far, its estimated "
                  "error and a stop button; 0: any port that is free")
      ->check(CLI::Range(0, 65535))
      ->type_name("PORT");
}

LiveView::LiveView(const LiveOptions& options, const std::string& image)
    : asked_(-kStillThere), last_(-kLeastBetween) {
  if (!options.display.empty())
    viewer_ = std::make_unique<ViewerConnection>(options.display, image);
  if (!options.serve) return;
  try {
    server_ = serveLocally(*options.serve,
                           [this](const HttpRequest& request) { return answer(request); });
  } catch (const std::runtime_error& e) {
    throw InputError(fmt::format("--serve {}: {}", *options.serve, e.what()));
  }
}

LiveView::~LiveView() = default;

std::string LiveView::address() const {
  return server_ ? fmt::format("http://127.0.0.1:{}/", server_->port()) : "";
}

void LiveView::describe(json facts) {
  if (!server_) return;
  // Names of files are not always UTF-8.
  facts = json::parse(facts.dump(-1, ' ', false, json::error_handler_t::replace));
  std::string page = filledPage(page::kLiveHtml, page::kLiveStyle, page::kLiveScript, facts);
  const std::lock_guard lock(mutex_);
  page_ = std::move(page);
}

void LiveView::progress(const RenderProgress& progress) {
  if (!server_) return;
  const std::lock_guard lock(mutex_);
  progress_ = progress;
}

HttpAnswer LiveView::answer(const HttpRequest& request) {
  const HttpAnswer refused{403, "text/plain", "for pages of this machine alone\n"};
  if (!request.local) return refused;
  if (request.method == "POST" && request.path == "/stop") {
    if (request.token != "stop") return refused;
    StopSignals::request();
    return {200, "application/json", "{}"};
  }
  if (request.method == "GET" && request.path == "/state") return state(request.seen);
  if (request.method == "GET" && request.path == "/") {
    const std::lock_guard lock(mutex_);
    if (page_.empty()) return {200, "text/html", kNotYet};
    return {200, "text/html; charset=utf-8", page_};
  }
  return {404, "text/plain", "no such page\n"};
}

// The pictures are sent where they are others than the page has seen.
HttpAnswer LiveView::state(const std::string& seen) {
  std::shared_ptr<const Shown> shown;
  json state;
  {
    const std::lock_guard lock(mutex_);
    asked_ = wallClock();
    shown = shown_;
    state = {{"fraction", finite(progress_.fraction)},
             {"seconds", finite(progress_.elapsedSeconds)},
             {"rate", finite(progress_.rate)},
             {"unit", progress_.rateUnit},
             {"stopping", StopSignals::requested().load()},
             {"number", 0},
             {"over", false}};
    if (shown) taken_ = shown->number;
  }
  if (!shown) return {200, "application/json", state.dump()};
  state.update(shown->state);
  std::string text = state.dump();
  if (seen != std::to_string(shown->number)) {
    text.back() = ',';
    text += shown->pictures + "}";
  }
  return {200, "application/json", text};
}

bool LiveView::somebodyWaits() const {
  if (viewer_ && viewer_->wantsPicture()) return true;
  const std::lock_guard lock(mutex_);
  return wallClock() - asked_ < kStillThere && (!shown_ || taken_ == shown_->number);
}

void LiveView::show(const RenderResult& result, bool over, bool written) {
  if (viewer_) viewer_->show(std::make_shared<const Image>(result.image));
  if (!server_) return;
  auto shown = std::make_shared<Shown>();
  shown->state = {{"over", over},
                  {"written", written},
                  {"interrupted", result.interrupted},
                  {"width", result.image.width},
                  {"height", result.image.height},
                  {"pictureSeconds", finite(result.wallSeconds)},
                  {"samples", result.samples},
                  {"sampleUnit", result.sampleUnit},
                  {"meanLuminance", finite(result.meanLuminance)},
                  {"meanLuminanceError", finite(result.meanLuminanceError)},
                  {"acceptance", acceptanceOf(result.statistics)}};
  if (result.statistics.is_object())
    shown->state["notFinite"] = result.statistics.value("not finite", 0LL);
  json pixels{{"pixels", embeddedPixels(result.image)}};
  if (!result.variance.pixels.empty())
    pixels["error"] = embeddedValues(standardErrors(result.variance));
  const std::string text = pixels.dump();
  shown->pictures = text.substr(1, text.size() - 2);
  const std::lock_guard lock(mutex_);
  shown->number = shown_ ? shown_->number + 1 : 1;
  shown->state["number"] = shown->number;
  shown_ = std::move(shown);
}

void LiveView::look(RenderInProgress& render) {
  const double now = wallClock();
  if (render.isOver() || now - last_ < std::max(kLeastBetween, kShareOfTime * cost_) ||
      !somebodyWaits())
    return;
  render.pause([&] {
    try {
      const RenderResult result = render.result();
      if (result.samples > 0 || result.meanLuminance > 0) show(result, false, false);
    } catch (const std::exception&) {
      // What is wrong with the picture is said when it is to be written.
    }
  });
  last_ = wallClock();
  cost_ = last_ - now;
}

void LiveView::finish(const RenderResult& result, bool written) {
  if (!wanted()) return;
  show(result, true, written);
  const double since = wallClock();
  const auto waits = [&] {
    const std::lock_guard lock(mutex_);
    return wallClock() - asked_ < kStillThere && taken_ != shown_->number;
  };
  while (server_ && waits() && wallClock() - since < kLastNews)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

}  // namespace h2mc
