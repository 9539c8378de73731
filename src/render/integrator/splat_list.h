// SPDX-License-Identifier: MIT
// How many groups of work share one film: what they add waits in lists, and goes on the film in their
// order, whatever threads there are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/image/film.h"

namespace h2mc {

// What one group adds to a film in one round: 24 bytes for each sample.
class SplatList {
 public:
  // As Film::splat.
  void splat(float filmX, float filmY, const Rgbf& value) {
    splats_.push_back({filmX, filmY, value});
  }
  std::size_t size() const { return splats_.size(); }
  void clear();
  // The splats alone: to be sorted anew.
  template <class Archive>
  void archive(Archive& archive) {
    archive(splats_);
  }

  // Splits the film's rows into `bands` equal parts and finds which splats reach each of them. To be called
  // when all splats are there; different lists may be sorted at the same time.
  template <class Real>
  void sort(const BasicFilm<Real>& film, int bands);
  // Adds those that reach a band to its rows, in the order in which they came. Precondition: sorted, for a
  // film of the same settings.
  template <class Real>
  void addBand(int band, int half, BasicFilm<Real>& film) const;

 private:
  struct Splat {
    float x, y;
    Rgbf value;
  };
  std::vector<Splat> splats_;
  std::vector<std::uint32_t> order_;  // indices of splats, band by band
  std::vector<std::uint32_t> begin_;  // of each band in order_; its last entry is the end
};

// Into how many bands rows are split for so many threads (0: one a core). The sums on a film do not depend
// on it.
int bandCount(int threads, int height);

// One list of a film, and the half of the picture that it counts for.
struct FilmPart {
  SplatList* list;
  int half = 0;
};

// Adds the lists to the film in their order, on `threads` threads. Precondition: sorted for
// bandCount(threads, film.height()) bands.
template <class Real>
void addKeeping(std::span<const FilmPart> parts, int threads, BasicFilm<Real>& film);
// The same, and empties them.
template <class Real>
void addInOrder(std::span<const FilmPart> parts, int threads, BasicFilm<Real>& film);

}  // namespace h2mc
