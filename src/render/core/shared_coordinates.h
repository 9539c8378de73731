// SPDX-License-Identifier: MIT
// The primary coordinates that belong to no technique.
#pragma once

namespace h2mc {

// Which of them there are: in a scene, or that a path depends on. In vectors of coordinates they follow the
// technique's, the two of the aperture before time.
struct SharedCoordinates {
  bool aperture = false, time = false;

  int count() const { return (aperture ? 2 : 0) + (time ? 1 : 0); }
};
inline constexpr int kMostShared = 3;

}  // namespace h2mc
