// SPDX-License-Identifier: MIT
#include "inspect/film_preview.h"

#include <algorithm>
#include <cmath>

#include "inspect/path_search.h"
#include "render/core/index.h"
#include "render/integrator/common_options.h"
#include "render/integrator/parallel_rounds.h"
#include "render/path/bidirectional.h"

namespace h2mc {
namespace {
constexpr std::uint64_t kStream = 0x696e7373;
constexpr int kLongestEdge = 160, kSamples = 4;
// The longer paths add little that can be seen at this size.
constexpr int kMostEdges = 8;
}  // namespace

Image previewFilm(const Scene& scene, int maxLength, std::uint64_t seed, int threads,
                  const std::atomic<bool>* stop) {
  const double longest = std::max(scene.film.width, scene.film.height);
  const double scale = std::min(1.0, kLongestEdge / longest);
  const auto size = [&](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * scale)));
  };
  Image image(size(scene.film.width), size(scene.film.height));
  // A row's samples light pixels in other rows too: all are added in the rows' order.
  struct Splat {
    int x, y;
    Rgbf value;
  };
  std::vector<std::vector<Splat>> splats(static_cast<std::size_t>(image.height));
  parallelFor(threads, image.height, [&](int row) {
    BidirectionalSampler sampler(std::min(maxLength, kMostEdges));
    Random random(seed, kStream, static_cast<std::uint64_t>(row));
    for (int i = 0; i < image.width * kSamples && !(stop && *stop); ++i) {
      const int column = i / kSamples;
      const float x =
          (static_cast<float>(column) + random.uniform()) / static_cast<float>(image.width);
      const float y =
          (static_cast<float>(row) + random.uniform()) / static_cast<float>(image.height);
      sampler.sample(scene, random, std::min(x, kBelowOne), std::min(y, kBelowOne), 1,
                     [&](const BidirectionalSampler::Connection& c) {
                       splats[at(row)].push_back({pixelAt(c.filmX, image.width),
                                                  pixelAt(c.filmY, image.height), c.contribution});
                     });
    }
  });
  for (const auto& ofRow : splats)
    for (const Splat& s : ofRow) image.at(s.x, s.y) += s.value * (1.f / kSamples);
  return image;
}

}  // namespace h2mc
