// SPDX-License-Identifier: MIT
// Reconnection: scatterings whose primary coordinates follow from where the path is to go, on either subpath.
#pragma once

#include "render/core/random.h"
#include "render/path/path.h"

namespace h2mc {

// The primary coordinates of a scattering, and the lobe that they draw.
struct ScatterSample {
  Vec2f u{0};
  float choice = 0;
  LobeId lobe;
};

// Those with which what comes from the local direction `wi` goes on along `wo`, as the technique itself distributes
// them given both: the lobe with the probability lobePdf / pdf among the non-delta ones, the choice uniformly in the
// lobe's interval. False where no lobe makes the direction.
bool invertScattering(const Scene& scene, PrimitiveId id, const Vec2f& uv, const Vec3f& wi,
                      const Vec3f& wo, Random& random, ScatterSample& sample);
// The same for a delta lobe; coordinates that nothing depends on are uniform. False where it is never chosen.
bool invertDelta(const Scene& scene, PrimitiveId id, const Vec2f& uv, const Vec3f& wi, LobeId lobe,
                 Random& random, ScatterSample& sample);

// Sets lobe and coordinates of vertex i >= 1 of a side's subpath so that it scatters along unit `direction`, by
// invertScattering.
bool aim(const Scene& scene, Path& path, Side side, int i, const Vec3f& direction, Random& random);

// The same for a vertex that is to go on through a delta lobe.
bool aimDelta(const Scene& scene, Path& path, Side side, int i, LobeId lobe, Random& random);

// Goes on from vertex i, by the lobe and the coordinates that it has, to vertex i + 1 on the primitive `next`,
// without casting a ray; camera only: to an environment if `next` is not valid. False where nothing goes
// that way.
bool follow(const Scene& scene, Path& path, Side side, int i, PrimitiveId next);

// log of the density with which aim and aimDelta draw lobes and choice coordinates of all of the path's
// scatterings, given its vertices. (The choice of light and primitive is uniform in its own interval, and not
// in it.)
double logLobeDensity(const Scene& scene, const Path& path);

}  // namespace h2mc
