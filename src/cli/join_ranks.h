// SPDX-License-Identifier: MIT
// Renders by several processes that mpirun or srun has started.
#pragma once

#include <functional>
#include <memory>

#include "render/integrator/ranks.h"

namespace h2mc {

// Where this process stands among those that were started together, as the environment says: before MPI is asked.
struct RankPlace {
  int rank = 0, count = 1;
  bool alone() const { return count <= 1; }
  // Whether it is the one that talks of what all of them find.
  bool talks() const { return rank == 0; }
};
RankPlace rankPlace();

// Where something has gone wrong: all but the first wait a while for it to end before them. mpirun ends the others as
// soon as one has ended, and with them what the first one has to say or to write.
void letFirstEnd();

// Joins the others; null where there are none. Throws InputError where there are and this build can't join them.
std::unique_ptr<Ranks> joinRanks();

// Calls work(), and returns its exit code or that of what it has thrown, which the first rank says. Whatever becomes of
// the ranks, they end in order; where one is lost, after the first. May end the process by itself.
int runOnRanks(Ranks& ranks, const std::function<int()>& work);

}  // namespace h2mc
