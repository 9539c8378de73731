// SPDX-License-Identifier: MIT
// Rendering from Python.
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "mcmc/render/integrator_choice.h"
#include "mcmc/render/render_report.h"
#include "python/module.h"
#include "render/integrator/features.h"
#include "render/integrator/layers.h"

namespace h2mc::python {
namespace {

// A render on a thread of its own, so that Python's can look after Ctrl-C and call back.
class Running {
 public:
  Running(Integrator& integrator, const Scene& scene, RenderRequest request,
          FeatureRequest features) {
    request.stop = &stop_;
    features.stop = &stop_;
    request.progress = [this](const RenderProgress& progress) {
      const std::lock_guard lock(mutex_);
      progress_ = progress;
    };
    thread_ = std::thread(
        [this, &integrator, &scene, request = std::move(request), features = std::move(features)] {
          std::exception_ptr error;
          RenderResult result;
          std::vector<Layer> layers;
          try {
            layers = renderFeatures(scene, features);
            result = integrator.render(scene, request);
          } catch (...) {
            error = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          result_ = std::move(result);
          features_ = std::move(layers);
          error_ = error;
          over_ = true;
          changed_.notify_all();
        });
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() { stop(); }

  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

  // Waits for a moment; whether it is over.
  bool wait() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::milliseconds(50), [this] { return over_; });
  }
  // News since the last call.
  std::optional<RenderProgress> progress() {
    const std::lock_guard lock(mutex_);
    return std::exchange(progress_, std::nullopt);
  }
  // Precondition: it is over.
  RenderResult finish() {
    stop();
    if (error_) std::rethrow_exception(error_);
    return std::move(result_);
  }
  // The layers of the pass before it. Precondition: it is over.
  const std::vector<Layer>& features() const { return features_; }

 private:
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<RenderProgress> progress_;
  RenderResult result_;
  std::vector<Layer> features_;
  std::exception_ptr error_;
  bool over_ = false;
  std::thread thread_;
};

std::string wishOf(const std::string& integrator, const py::dict& options) {
  std::string wish = integrator;
  const char* gap = integrator.find(':') == std::string::npos ? ":" : ",";
  for (const auto& [name, value] : options) {
    const std::string text = py::isinstance<py::bool_>(value)
                                 ? (value.cast<bool>() ? "true" : "false")
                                 : std::string(py::str(value));
    wish += gap + std::string(py::str(name)) + "=" + text;
    gap = ",";
  }
  return wish;
}

// Of shape (height, width, channels), without the last one where there is one channel alone.
py::array_t<float> layerArray(const Layer& layer, const Image& image) {
  const auto channels = static_cast<py::ssize_t>(layer.channels.size());
  std::vector<py::ssize_t> shape{image.height, image.width};
  if (channels > 1) shape.push_back(channels);
  py::array_t<float> array(shape);
  std::copy(layer.values.begin(), layer.values.end(), array.mutable_data());
  return array;
}

py::tuple render(const ScenePtr& scene, const std::string& integrator, const py::dict& options,
                 double time, long long samplesPerPixel, long long mutationsPerPixel,
                 std::optional<std::uint64_t> seed, int threads, const py::object& progress,
                 const std::optional<std::vector<std::string>>& aov, int aovSamples) {
  const int budgets = (time != 0) + (samplesPerPixel != 0) + (mutationsPerPixel != 0);
  if (budgets > 1)
    throw UserError(
        "time, samples_per_pixel and mutations_per_pixel exclude one another: give one");
  if (!(time >= 0) || samplesPerPixel < 0 || mutationsPerPixel < 0)
    throw UserError("time, samples_per_pixel, mutations_per_pixel: expected a number above 0");
  if (threads < 0) throw UserError("threads: expected a number above 0, or 0 for one a core");
  if (aovSamples < 1 || aovSamples > kMostFeatureSamples)
    throw UserError("aov_samples: expected a number from 1 to " +
                    std::to_string(kMostFeatureSamples));
  const std::vector<LayerKind> kinds = layerKinds(aov.value_or(std::vector<std::string>()), "aov");
  const IntegratorChoice choice = chooseIntegrator(wishOf(integrator, options), *scene);
  RenderRequest request;
  request.budget = {time, samplesPerPixel, mutationsPerPixel};
  request.seed = seed.value_or(scene->seed.value_or(0));
  request.threads =
      threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));

  request.pixelStatistics = statisticsFor(kinds);

  FeatureRequest features;
  features.layers = featuresAmong(kinds);
  features.samplesPerPixel = aovSamples;
  features.seed = request.seed;
  features.threads = request.threads;
  Running running(*choice.integrator, *scene, request, features);
  const auto interruptible = [&] {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (const auto news = running.progress(); news && !progress.is_none())
      progress(news->fraction, news->elapsedSeconds, news->rate);
  };
  for (bool over = false; !over;) {
    {
      const py::gil_scoped_release released;
      over = running.wait();
    }
    try {
      interruptible();
    } catch (py::error_already_set&) {
      // The thread that renders does not need Python, which others may want to go on with meanwhile.
      const py::gil_scoped_release released;
      running.stop();
      throw;
    }
  }
  const RenderResult result = running.finish();
  const py::object statistics =
      toPython(renderReport(choice.options, request.seed, request.threads, result));
  if (!aov) return py::make_tuple(toArray(result.image), statistics);
  py::dict layers;
  for (const Layer& layer : layersOf(kinds, running.features(), result))
    layers[py::str(layer.name)] = layerArray(layer, result.image);
  return py::make_tuple(toArray(result.image), statistics, layers);
}

}  // namespace

void addRender(SceneClass& scene) {
  scene.def(
      "render", &render, py::arg("integrator") = "", py::arg("options") = py::dict(), py::kw_only(),
      py::arg("time") = 0, py::arg("samples_per_pixel") = 0, py::arg("mutations_per_pixel") = 0,
      py::arg("seed") = py::none(), py::arg("threads") = 0, py::arg("progress") = py::none(),
      py::arg("aov") = py::none(), py::arg("aov_samples") = 16,
      R"(Renders; returns (image, statistics), or (image, statistics, layers) where `aov` is given.

integrator: "h2mc", "path", "mmlt:maxDepth=8", ...; "" is what the scene says, else h2mc.
options: the integrator's, as a dict. `h2mc list integrators` shows all.
time (seconds), samples_per_pixel, mutations_per_pixel: one of them, or the integrator's own default.
seed: the scene's, or 0; the same seed gives the same image, whatever the number of threads, but for `time`.
progress: called a few times a second with (fraction, seconds, samples or mutations a second).
aov: names of layers as of `h2mc render --aov`: albedo, normal, depth, position, time, id, variance, mutations.
aov_samples: camera rays a pixel, for those that are made by such.

image: float32, (height, width, 3). statistics: a dict as `h2mc render --stats` writes it. layers: a dict of float32
arrays, (height, width, 3), or (height, width) for those of a single value.
Python's lock is free meanwhile. Ctrl-C, and what `progress` raises, end the render.)");
}

}  // namespace h2mc::python
