// The shortest paths by path tracing, beside the chains: a Metropolis chain is wasted on them.
#pragma once

#include "render/integrator/integrator.h"
#include "render/scene/option_set.h"

namespace h2mc {

// Paths of one and two edges, in parts: each makes it less noisy.
class DirectLighting {
 public:
  static constexpr int kLongest = 2;  // in edges

  // By the options minDepth and directSamples; the request's seed, threads and stop flag.
  // Keeps references.
  DirectLighting(const Scene& scene, const OptionSet& options, const RenderRequest& request);

  // Whether it is split off from the chains at all.
  bool wanted() const { return wanted_ != 0 && minDepth_ <= kLongest; }
  bool interrupted() const { return result_.interrupted; }
  const Image& image() const { return result_.image; }

  // Brings it up to what a render of so many seconds, or of so many mutations a pixel, gets. Both
  // may only grow from call to call.
  void extendTo(double renderSeconds, long long mutationsPerPixel);

  // Adds image, mean luminance and statistics to those of the longer paths, whose image may be
  // empty.
  void addTo(RenderResult& result) const;

 private:
  void merge(const RenderResult& part);

  const Scene& scene_;
  const RenderRequest& request_;
  int wanted_, minDepth_;
  double seconds_ = 0;       // of renders so far
  long long perPixel_ = 0;   // samples so far
  std::uint64_t parts_ = 0;  // a seed each
  RenderResult result_;
};

}  // namespace h2mc
