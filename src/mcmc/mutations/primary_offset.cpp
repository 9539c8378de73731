// SPDX-License-Identifier: MIT
#include "mcmc/mutations/primary_offset.h"

#include <cmath>

#include "render/core/index.h"
#include "render/core/unit_interval.h"

namespace h2mc {
namespace {

bool wrapsAt(CoordinateMask wraps, int i) { return (wraps >> i) & 1; }

}  // namespace

bool addOffset(const PrimarySample& from, const float* offset, int dimension, CoordinateMask wraps,
               PrimarySample& to) {
  for (int i = 0; i < dimension; ++i) {
    const auto k = at(i);
    const float moved = from.u[k] + offset[i];
    if (wrapsAt(wraps, i)) {
      if (!(std::abs(offset[i]) < 0.5f)) return false;
      to.u[k] = wrap(moved);
    } else {
      if (!(moved >= 0 && moved < 1)) return false;
      to.u[k] = moved;
    }
  }
  return true;
}

void offsetBetween(const PrimarySample& from, const PrimarySample& to, int dimension,
                   CoordinateMask wraps, float* offset) {
  for (int i = 0; i < dimension; ++i) {
    const auto k = at(i);
    offset[i] = to.u[k] - from.u[k];
    if (wrapsAt(wraps, i)) offset[i] -= std::round(offset[i]);
  }
}

bool addToTime(const PrimarySample& from, float offset, PrimarySample& to) {
  to.time = from.time + offset;
  return to.time >= 0 && to.time < 1;
}

}  // namespace h2mc
