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

RenderClock::RenderClock() : wall_(wallClock()), cpu_(cpuClock()) {}

double RenderClock::wallSeconds() const { return stands_ ? standsWall_ : wallClock() - wall_; }

double RenderClock::cpuSeconds() const { return stands_ ? standsCpu_ : cpuClock() - cpu_; }

void RenderClock::exclude(const std::function<void()>& work) {
  standsWall_ = wallSeconds();
  standsCpu_ = cpuSeconds();
  stands_ = true;
  work();
  stands_ = false;
  wall_ = wallClock() - standsWall_;
  cpu_ = cpuClock() - standsCpu_;
}

RoundsResult runRounds(const RenderRequest& request, const RenderClock& clock, int groups,
                       const RoundsPlan& plan, const std::function<void(int, long long)>& work) {
  RoundsResult result;
  const double start = clock.wallSeconds();
  const bool timed = plan.seconds > 0;
  const auto stopped = [&] { return request.stop && request.stop->load(); };
  // A time is reached where one more round would end further from it than we are now.
  const auto reached = [&](double limit) {
    const double elapsed = clock.wallSeconds();
    const double aRound = (elapsed - start) / static_cast<double>(result.rounds);
    return elapsed + aRound / 2 > limit;
  };
  std::size_t mark = 0;
  while (plan.rounds == 0 || result.rounds < plan.rounds) {
    if (stopped()) {
      result.interrupted = true;
      break;
    }
    if (timed && result.rounds > 0 && reached(plan.seconds)) break;
    if (result.rounds > 0 && plan.betweenRounds) plan.betweenRounds();
    parallelFor(request.threads, groups, [&](int group) { work(group, result.rounds); });
    ++result.rounds;
    if (request.progress) {
      const double now = clock.wallSeconds();
      const double done = static_cast<double>(result.rounds);
      const double fraction =
          plan.rounds > 0 ? done / static_cast<double>(plan.rounds) : now / plan.seconds;
      request.progress(
          {std::min(fraction, 1.0), now, done * plan.unitsPerRound / (now - start), plan.unit});
    }
    const auto passed = [&] {
      return timed ? reached(plan.marks[mark])
                   : static_cast<double>(result.rounds) >= plan.marks[mark];
    };
    for (; mark < plan.marks.size() && passed(); ++mark) plan.atMark(mark, result);
  }
  // A mark at the limit itself may not have been seen to be passed.
  if (!result.interrupted)
    for (; mark < plan.marks.size(); ++mark) plan.atMark(mark, result);
  return result;
}

}  // namespace h2mc
