// SPDX-License-Identifier: MIT
// What a group of chains leaves for the picture.
#pragma once

#include "render/integrator/splat_list.h"

namespace h2mc {

// Splats of a group's chains for a film that groups share.
struct SummedFilm {
  SplatList splats;
  // Of states: the sum of weight * luminance(contribution) / target.
  double overTarget = 0;

  void splat(float filmX, float filmY, const Rgbf& value) { splats.splat(filmX, filmY, value); }
  // A state, or a part of one: its contribution over its target and `shared` (see KernelMixture).
  void splatState(float filmX, float filmY, const Rgbf& contribution, double weight, double target,
                  double shared) {
    splat(filmX, filmY, contribution * static_cast<float>(weight / (target + shared)));
    overTarget += weight * luminance(contribution) / target;
  }
  void clear() {
    splats.clear();
    overTarget = 0;
  }
};

// `states` for n mutations is to be divided by n and multiplied by the target's mean, `samples` (of large
// steps) to be divided by the number of large steps.
struct ChainFilms {
  SummedFilm states, samples;
  void clear() {
    states.clear();
    samples.clear();
  }
};

}  // namespace h2mc
