// Work in groups and rounds: the same image whatever the number of threads.
#pragma once

#include <functional>

#include "render/camera/film_settings.h"
#include "render/integrator/integrator.h"

namespace h2mc {

// How many groups work is split into. Each has a film of its own, merged in their order at the end,
// so the number depends on the film's size (memory) and on nothing else.
int groupCount(const FilmSettings& film);

struct RoundsResult {
  long long rounds = 0;  // completed
  double wallSeconds = 0, cpuSeconds = 0;
  bool interrupted = false;
};

struct RoundsPlan {
  long long rounds = 0;  // 0: until the time is up
  double seconds = 0;    // 0: until the rounds are done
  double unitsPerRound = 1;
  std::string unit;
};

// Calls work(group, round) for all groups of a round in parallel, round after round, until the plan
// is fulfilled or the request's stop flag is set. A started round is always completed: all groups
// have done the same number of rounds when it returns.
RoundsResult runRounds(const RenderRequest& request, int groups, const RoundsPlan& plan,
                       const std::function<void(int group, long long round)>& work);

// Seconds since some fixed point, and of processor time this process has used.
double wallClock();
double cpuClock();

// Calls work(0 .. count - 1) in parallel on `threads` threads (0: one a core).
void parallelFor(int threads, int count, const std::function<void(int)>& work);

}  // namespace h2mc
