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

bool addToShared(const SharedCoordinates& there, const PrimarySample& from, const float* offset,
                 PrimarySample& to) {
  float x[kMostShared];
  getShared(there, from, x);
  bool inside = true;
  for (int i = 0; i < there.count(); ++i) {
    x[i] += offset[i];
    inside = inside && x[i] >= 0 && x[i] < 1;
  }
  to.time = from.time;
  to.aperture = from.aperture;
  setShared(there, x, to);
  return inside;
}

void sharedOffsetBetween(const SharedCoordinates& there, const PrimarySample& from,
                         const PrimarySample& to, float* offset) {
  float a[kMostShared], b[kMostShared];
  getShared(there, from, a);
  getShared(there, to, b);
  for (int i = 0; i < there.count(); ++i) offset[i] = b[i] - a[i];
}

}  // namespace h2mc
