// SPDX-License-Identifier: MIT
// What every integrator offers to the commands.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "render/image/image.h"
#include "render/integrator/pixel_statistics.h"
#include "render/scene/option_set.h"

namespace h2mc {

class Archive;
class Ranks;
struct Scene;

// How long to render; all zero means the integrator's own default. Where a time and a number are
// given, whichever is reached first.
struct RenderBudget {
  double seconds = 0;
  long long samplesPerPixel = 0;
  long long mutationsPerPixel = 0;
};

struct RenderProgress {
  double fraction;  // of the budget, 0 .. 1
  double elapsedSeconds;
  double rate;  // samples or mutations per second
  std::string rateUnit;
};

struct RenderResult;

// A render between two rounds, for whoever watches it.
class RenderInProgress {
 public:
  virtual ~RenderInProgress() = default;
  // Of all ranks (ranks.h), before result() and save(): brings together what they have. Throws RankLost.
  virtual void gather() {}
  // What there is so far; changes nothing.
  virtual RenderResult result() const = 0;
  // Whether a render that goes on from save() gives, with a budget in samples or mutations, the same image as this one
  // will, to the bit.
  virtual bool isExact() const = 0;
  // Whether the render is over; this is then the last call.
  virtual bool isOver() const = 0;
  // Writes the state. Throws ArchiveError.
  virtual void save(Archive& archive) = 0;
  // Calls work() without counting its time as the render's.
  virtual void pause(const std::function<void()>& work) = 0;
};

struct RenderRequest {
  RenderBudget budget;
  // Where on the way the image is wanted too: ascending, none beyond the budget, in seconds where the
  // budget is a time, else in samples or mutations a pixel. atMark(i, the result so far) is called
  // from the rendering thread after the round of samples that ends nearest to a time, or first
  // reaches a number; two marks within a round get the same image. What making it and the call take
  // is not counted as time. An interruption leaves out the marks to come.
  std::vector<double> marks;
  std::function<void(std::size_t mark, const RenderResult&)> atMark;
  std::uint64_t seed = 0;
  int threads = 0;  // 0: one a core
  std::function<void(const RenderProgress&)>
      progress;                             // called from the rendering thread; may be empty
  const std::atomic<bool>* stop = nullptr;  // set: end in order, keep what was done
  // Called from the rendering thread after each round, and once when the render is over; may be empty. With it, an
  // interruption waits some tenths of a second for a state that isExact().
  std::function<void(RenderInProgress&)> watch;
  // What save() wrote in a render of the same scene, integrator, options and seed, to go on from; null: from the
  // beginning. The budget is that of both together and may be larger than it was. Without marks.
  Archive* resume = nullptr;
  // The processes that render this together; null: this one does it alone. `stop` is then that of the ranks, and all of
  // them are asked for the same and have the same result, but for what each has counted since it was last gathered.
  Ranks* ranks = nullptr;
  PixelStatistics pixelStatistics;
};

struct RenderResult {
  Image image;
  // What RenderRequest::pixelStatistics asks for, else empty. Variance: of each channel of a pixel's value. Each by
  // itself is as uncertain as the square of a normal variate; its expectation is right where the halves are
  // independent. The square of the value where there is no second half yet.
  Image variance;
  std::vector<float> counts;  // of mutations or samples on each pixel
  double wallSeconds = 0, cpuSeconds = 0;
  long long samples = 0;                             // all of them, not a pixel
  std::string sampleUnit;                            // "samples" or "mutations"
  double meanLuminance = 0, meanLuminanceError = 0;  // of the image; its standard error
  bool interrupted = false;
  nlohmann::json statistics;
};

// A picture that is not one. what() names the pixel.
class FilmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Image and mean luminance in the file's units. What a filter with negative lobes has left below zero becomes zero.
// Throws UserError where a pixel is beyond float in these units, FilmError where one is not finite before.
void finish(const Scene& scene, RenderResult& result);

class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual RenderResult render(const Scene& scene, const RenderRequest& request) = 0;
};

struct IntegratorFactory {
  IntegratorPlugin plugin;
  std::function<std::unique_ptr<Integrator>(const OptionSet&)> create;
};

// path and bdpt; the Metropolis methods are in mcmc/integrators.h.
std::span<const IntegratorFactory> renderIntegrators();

}  // namespace h2mc
