// SPDX-License-Identifier: MIT
// What a group of chains leaves for the picture.
#pragma once

#include "mcmc/chain/division.h"
#include "render/integrator/splat_list.h"

namespace h2mc {

// Splats of a group's states, for a film that groups share.
struct StateFilm {
  SplatList splats;
  // The sum of weight * luminance(contribution) / target.
  double overTarget = 0;
  // Where mutations have landed, each with its share, in the first channel: where that is asked for.
  bool counting = false;
  SplatList landed;

  void land(float filmX, float filmY, double weight) {
    if (counting) landed.splat(filmX, filmY, {static_cast<float>(weight), 0, 0});
  }
  // A state, or a part of one.
  void splat(float filmX, float filmY, const Rgbf& contribution, double weight, double target,
             const Division& division) {
    splats.splat(filmX, filmY,
                 contribution * static_cast<float>(weight / division.ofState(target)));
    overTarget += weight * luminance(contribution) / target;
  }
  void clear() {
    splats.clear();
    landed.clear();
    overTarget = 0;
  }
  template <class Archive>
  void archive(Archive& archive) {
    archive(splats, overTarget, landed);
  }
};

// Of its independent samples.
struct SampleFilm {
  SplatList splats;

  // A path of a sample that covers all techniques with density 1, or that of one technique with `density`.
  void splat(float filmX, float filmY, const Rgbf& contribution, double target,
             const Division& division, double density = 1) {
    splats.splat(filmX, filmY,
                 contribution * static_cast<float>(division.ofSample(target) / density));
  }
  void clear() { splats.clear(); }
};

// `states` for n mutations is to be divided by n and multiplied by the target's mean, `samples` to be divided by their
// number.
struct ChainFilms {
  StateFilm states;
  SampleFilm samples;
  void clear() {
    states.clear();
    samples.clear();
  }
  // What there is to add: to be sorted anew.
  template <class Archive>
  void archive(Archive& archive) {
    archive(states, samples.splats);
  }
};

}  // namespace h2mc
