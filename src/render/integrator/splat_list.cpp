// SPDX-License-Identifier: MIT
#include "render/integrator/splat_list.h"

#include <tbb/task_arena.h>

#include <algorithm>

#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// Enough bands that threads share them evenly; more make sorting dearer.
constexpr int kBandsAThread = 4;

RowRange rowsOfBand(int band, int bands, int height) {
  return {static_cast<int>(static_cast<long long>(band) * height / bands),
          static_cast<int>(static_cast<long long>(band + 1) * height / bands)};
}

// The band that rowsOfBand has put a row into. In 32 bits, which divide faster.
int bandOfRow(int row, int bands, int height) {
  return static_cast<int>(
      (static_cast<std::uint32_t>(row + 1) * static_cast<std::uint32_t>(bands) - 1) /
      static_cast<std::uint32_t>(height));
}

}  // namespace

int bandCount(int threads, int height) {
  const int workers = threads > 0 ? threads : tbb::this_task_arena::max_concurrency();
  return std::clamp(kBandsAThread * workers, 1, height);
}

void SplatList::clear() {
  splats_.clear();
  order_.clear();
  begin_.clear();
}

// By counting: stable.
template <class Real>
void SplatList::sort(const BasicFilm<Real>& film, int bands) {
  const int height = film.height();
  const auto forEachBand = [&](auto&& visit) {
    for (std::size_t i = 0; i < splats_.size(); ++i) {
      const RowRange rows = film.rowsOf(splats_[i].y);
      const int first = bandOfRow(rows.begin, bands, height);
      const int last = rows.end - rows.begin == 1 ? first : bandOfRow(rows.end - 1, bands, height);
      for (int band = first; band <= last; ++band) visit(at(band), static_cast<std::uint32_t>(i));
    }
  };
  begin_.assign(at(bands) + 1, 0);
  forEachBand([&](std::size_t band, std::uint32_t) { ++begin_[band + 1]; });
  for (std::size_t band = 0; band < at(bands); ++band) begin_[band + 1] += begin_[band];
  order_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  forEachBand([&](std::size_t band, std::uint32_t i) { order_[next[band]++] = i; });
}

template <class Real>
void SplatList::addBand(int band, int half, BasicFilm<Real>& film) const {
  const RowRange rows = rowsOfBand(band, static_cast<int>(begin_.size()) - 1, film.height());
  for (std::uint32_t k = begin_[at(band)]; k < begin_[at(band) + 1]; ++k) {
    const Splat& s = splats_[order_[k]];
    film.splat(s.x, s.y, s.value, rows, half);
  }
}

template <class Real>
void addKeeping(std::span<const FilmPart> parts, int threads, BasicFilm<Real>& film) {
  parallelFor(threads, bandCount(threads, film.height()), [&](int band) {
    for (const FilmPart& part : parts) part.list->addBand(band, part.half, film);
  });
}

template <class Real>
void addInOrder(std::span<const FilmPart> parts, int threads, BasicFilm<Real>& film) {
  addKeeping(parts, threads, film);
  for (const FilmPart& part : parts) part.list->clear();
}

template void SplatList::sort(const BasicFilm<float>&, int);
template void SplatList::sort(const BasicFilm<double>&, int);
template void SplatList::addBand(int, int, BasicFilm<float>&) const;
template void SplatList::addBand(int, int, BasicFilm<double>&) const;
template void addKeeping(std::span<const FilmPart>, int, BasicFilm<float>&);
template void addKeeping(std::span<const FilmPart>, int, BasicFilm<double>&);
template void addInOrder(std::span<const FilmPart>, int, BasicFilm<float>&);
template void addInOrder(std::span<const FilmPart>, int, BasicFilm<double>&);

}  // namespace h2mc
