// SPDX-License-Identifier: MIT
// Points in a hashed grid: which of them lie within a distance.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "render/core/index.h"
#include "render/core/parallel.h"
#include "render/core/types.h"

namespace h2mc {

// Copies of points, sorted by the cell that they are in [Teschner et al. 2003]. Point: copyable, with a position p.
// Memory is kept from one build to the next: 8 bytes for each point besides the points, and 4 to 8 for cells.
template <class Point>
class PointGrid {
 public:
  // Lists and points of each list, at most.
  static constexpr std::size_t kMostLists = 256, kMostInList = std::size_t{1} << 24;

  // Takes all points of the lists, in cells with edges of this length. The order of the points is a function of the
  // lists, not of the threads. Preconditions: cell > 0; no more than kMostLists lists of kMostInList points, 2^31 in
  // all.
  void build(std::span<const std::vector<Point>> lists, float cell, int threads);

  std::size_t size() const { return points_.size(); }

  // Calls visit(point, squared distance) for all points that are nearer than `radius` to `centre`, in an order that is
  // the same after every build of the same lists. Looks into (2 + 2 radius / cell)^3 cells at most: cells of twice the
  // usual radius are a good choice.
  template <class Visit>
  void visit(const Vec3f& centre, float radius, Visit&& visit) const {
    if (points_.empty()) return;
    const float reach = radius * 1.000001f;  // of what rounding lets come nearer
    const Cell low = cellOf(centre - Vec3f(reach)), high = cellOf(centre + Vec3f(reach));
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const Cell cell{x, y, z};
          const std::uint32_t bucket = bucketOf(cell);
          const std::uint32_t end = ends_[bucket];
          for (std::uint32_t i = bucket == 0 ? 0 : ends_[bucket - 1]; i < end; ++i) {
            const float d2 = distance2(points_[i].p, centre);
            // Cells may share a bucket.
            if (d2 < radius * radius && cellOf(points_[i].p) == cell) visit(points_[i], d2);
          }
        }
  }

 private:
  struct Cell {
    int x, y, z;
    bool operator==(const Cell&) const = default;
  };
  struct Item {
    std::uint32_t bucket, list : 8, index : 24;
  };
  // Buckets are sorted in two steps: bins of consecutive ones, which threads share, then each bin by itself.
  static constexpr int kBinBits = 8;

  Cell cellOf(const Vec3f& p) const {
    constexpr float kFarthest = 1e9f;
    const auto index = [&](float x) {
      return static_cast<int>(std::floor(std::clamp(x * perCell_, -kFarthest, kFarthest)));
    };
    return {index(p.x), index(p.y), index(p.z)};
  }
  std::uint32_t bucketOf(const Cell& cell) const {
    const std::uint32_t sum = static_cast<std::uint32_t>(cell.x) * 0x8da6b343u +
                              static_cast<std::uint32_t>(cell.y) * 0xd8163841u +
                              static_cast<std::uint32_t>(cell.z) * 0xcb1ab31fu;
    return ((sum ^ (sum >> 15)) * 0x9e3779b1u) >> (32 - bits_);
  }
  std::uint32_t binOf(std::uint32_t bucket) const { return bucket >> (bits_ - kBinBits); }

  float perCell_ = 1;
  int bits_ = kBinBits;               // 2^bits_ buckets
  std::vector<Point> points_;         // by bucket
  std::vector<std::uint32_t> ends_;   // of each bucket in points_
  std::vector<Item> items_;           // by bin
  std::vector<std::uint32_t> place_;  // in items_, of each list's next item of each bin
};

template <class Point>
void PointGrid<Point>::build(std::span<const std::vector<Point>> lists, float cell, int threads) {
  constexpr std::size_t kBins = std::size_t{1} << kBinBits;
  perCell_ = 1 / cell;
  std::size_t count = 0;
  for (const auto& list : lists) count += list.size();
  bits_ = std::max(kBinBits, static_cast<int>(std::bit_width(count)));
  points_.resize(count);
  items_.resize(count);
  ends_.assign(std::size_t{1} << bits_, 0);
  place_.assign(lists.size() * kBins, 0);

  const auto listCount = static_cast<int>(lists.size());
  parallelFor(threads, listCount, [&](int l) {
    std::uint32_t* const counts = &place_[at(l) * kBins];
    for (const Point& point : lists[at(l)]) ++counts[binOf(bucketOf(cellOf(point.p)))];
  });
  std::uint32_t begin = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin)
    for (std::size_t l = 0; l < lists.size(); ++l) {
      std::uint32_t& place = place_[l * kBins + bin];
      const std::uint32_t inList = place;
      place = begin;
      begin += inList;
    }
  parallelFor(threads, listCount, [&](int l) {
    std::uint32_t* const next = &place_[at(l) * kBins];
    std::uint32_t index = 0;
    for (const Point& point : lists[at(l)]) {
      const std::uint32_t bucket = bucketOf(cellOf(point.p));
      items_[next[binOf(bucket)]++] = {bucket, static_cast<std::uint32_t>(l) & 255u,
                                       index++ & 0xffffffu};
    }
  });
  // The last list's next item of a bin is now the bin's end.
  const std::size_t perBin = ends_.size() / kBins;
  parallelFor(threads, static_cast<int>(kBins), [&](int bin) {
    if (lists.empty()) return;
    const std::uint32_t* const binEnds = &place_[(lists.size() - 1) * kBins];
    const std::uint32_t first = bin == 0 ? 0 : binEnds[bin - 1], last = binEnds[bin];
    for (std::uint32_t i = first; i < last; ++i) ++ends_[items_[i].bucket];
    std::uint32_t start = first;
    for (std::size_t bucket = at(bin) * perBin; bucket < (at(bin) + 1) * perBin; ++bucket) {
      const std::uint32_t inBucket = ends_[bucket];
      ends_[bucket] = start;
      start += inBucket;
    }
    for (std::uint32_t i = first; i < last; ++i) {
      const Item& item = items_[i];
      points_[ends_[item.bucket]++] = lists[item.list][item.index];
    }
  });
}

}  // namespace h2mc
