// SPDX-License-Identifier: MIT
#pragma once

namespace h2mc {

// Of a channel of linear RGB, albedo 0 or 1 of the ground, and turbidity 1 .. 10: six control points over the sun's
// elevation, each of which has the nine parameters of the distribution over the sky [Hosek and Wilkie 2012, eq. 8], and
// six of the mean radiance.
extern const float kSkyShape[3][2][10][54];
extern const float kSkyRadiance[3][2][10][6];

}  // namespace h2mc
