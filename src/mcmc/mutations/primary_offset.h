// SPDX-License-Identifier: MIT
// Offsets between points of a technique's primary space, some of whose coordinates wrap.
#pragma once

#include "render/path/primary_sample.h"

namespace h2mc {

// x + offset for the technique's continuous coordinates: those in `wraps` modulo 1. False when a coordinate that does
// not wrap leaves [0, 1), or a wrapping one has moved by half a turn or more, so that the offset is not the shortest
// way back: such proposals are rejected, in both directions.
bool addOffset(const PrimarySample& from, const float* offset, int dimension, CoordinateMask wraps,
               PrimarySample& to);

// The offset that leads from one sample to the other, the shortest way round where coordinates wrap.
void offsetBetween(const PrimarySample& from, const PrimarySample& to, int dimension,
                   CoordinateMask wraps, float* offset);

// The same for the coordinates that belong to no technique, which do not wrap; those that are not there stay.
bool addToShared(const SharedCoordinates& there, const PrimarySample& from, const float* offset,
                 PrimarySample& to);
void sharedOffsetBetween(const SharedCoordinates& there, const PrimarySample& from,
                         const PrimarySample& to, float* offset);

}  // namespace h2mc
