#include "render/integrator/parallel_rounds.h"

#include <sys/resource.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>

namespace h2mc {

int groupCount(const FilmSettings& film) {
  constexpr double kMemory = 1 << 30;
  const double bytes = 24.0 * film.width * film.height;
  return static_cast<int>(std::clamp(kMemory / bytes, 2.0, 32.0));
}

double wallClock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpuClock() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void parallelFor(int threads, int count, const std::function<void(int)>& work) {
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& range) {
          for (int i = range.begin(); i < range.end(); ++i) work(i);
        },
        tbb::simple_partitioner());
  });
}

RoundsResult runRounds(const RenderRequest& request, int groups, const RoundsPlan& plan,
                       const std::function<void(int, long long)>& work) {
  RoundsResult result;
  const double startWall = wallClock(), startCpu = cpuClock();
  const auto stopped = [&] { return request.stop && request.stop->load(); };
  while (plan.rounds == 0 || result.rounds < plan.rounds) {
    if (stopped()) {
      result.interrupted = true;
      break;
    }
    const double elapsed = wallClock() - startWall;
    if (plan.seconds > 0 && result.rounds > 0) {
      // Another round is begun if it will end nearer to the limit than we are now.
      const double aRound = elapsed / static_cast<double>(result.rounds);
      if (elapsed + aRound / 2 > plan.seconds) break;
    }
    parallelFor(request.threads, groups, [&](int group) { work(group, result.rounds); });
    ++result.rounds;
    if (request.progress) {
      const double now = wallClock() - startWall;
      const double done = static_cast<double>(result.rounds);
      const double fraction =
          plan.rounds > 0 ? done / static_cast<double>(plan.rounds) : now / plan.seconds;
      request.progress({std::min(fraction, 1.0), now, done * plan.unitsPerRound / now, plan.unit});
    }
  }
  result.wallSeconds = wallClock() - startWall;
  result.cpuSeconds = cpuClock() - startCpu;
  return result;
}

}  // namespace h2mc
