// SPDX-License-Identifier: MIT
#include "compare/insets.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace h2mc {
namespace {

struct Candidate {
  PixelRectangle place;
  double score;
};

double errorIn(const PixelRectangle& r, const Image& image, const Image& reference, double offset) {
  double sum = 0;
  for (int y = r.y; y < r.y + r.height; ++y)
    for (int x = r.x; x < r.x + r.width; ++x) {
      const double expected = luminance(reference.at(x, y));
      const double d = luminance(image.at(x, y)) - expected;
      sum += std::min(1.0, d * d / (expected * expected + offset));
    }
  return sum;
}

}  // namespace

std::vector<PixelRectangle> whereTheyDiffer(const std::vector<Image>& images,
                                            const Image& reference, std::size_t count) {
  const int w = std::max(8, reference.width / 9), h = std::max(6, w * 3 / 4);
  if (images.empty() || w > reference.width || h > reference.height) return {};
  double mean = 0;
  for (const Rgbf& p : reference.pixels) mean += luminance(p);
  mean /= static_cast<double>(reference.pixels.size());
  std::vector<Candidate> candidates;
  for (int y = 0; y + h <= reference.height; y += h / 2)
    for (int x = 0; x + w <= reference.width; x += w / 2) {
      const PixelRectangle place{x, y, w, h};
      double low = std::numeric_limits<double>::infinity(), high = 0;
      for (const Image& image : images) {
        const double error = errorIn(place, image, reference, 0.01 * mean * mean);
        low = std::min(low, error);
        high = std::max(high, error);
      }
      candidates.push_back({place, images.size() > 1 ? high - low : high});
    }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<PixelRectangle> chosen;
  for (const Candidate& c : candidates) {
    if (chosen.size() == count) break;
    const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](const PixelRectangle& other) {
      return std::abs(other.x - c.place.x) >= w || std::abs(other.y - c.place.y) >= h;
    });
    if (apart) chosen.push_back(c.place);
  }
  return chosen;
}

}  // namespace h2mc
