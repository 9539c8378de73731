// SPDX-License-Identifier: MIT
// How much of a ridge the target is around a path.
#pragma once

#include <atomic>

#include "inspect/local_model.h"
#include "render/path/path.h"

namespace h2mc {

struct Ridge {
  // By how much longer than wide the target is in the plane of the Hessian's two strongest eigenvectors: what the
  // quadratic says or what is really there, whichever is less; less too where it is so wide that isotropic steps meet
  // it, or too narrow to be seen beside one. 0 where the derivatives say nothing or the target does not fall off along
  // the strongest.
  double strength = 0;
  // Half the edge of a square of that plane that shows it.
  double half = 0;
};

// Traces some hundreds of the path's neighbours. Precondition: a positive target, and its model.
Ridge ridgeAt(const Scene& scene, const Path& path, const LocalModel& model, int threads,
              const std::atomic<bool>* stop);

}  // namespace h2mc
