// SPDX-License-Identifier: MIT
#include "render/integrator/parallel_rounds.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>

#include "render/integrator/ranks.h"

namespace h2mc {
namespace {

// How much later than asked, as a share of it, a pass may end.
constexpr double kLate = 0.05;

}  // namespace

int groupCount(long long units) {
  constexpr long long kUnits = 64;  // samples, or mutations
  return static_cast<int>(std::clamp<long long>(units / kUnits, 1, kMostGroups));
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

void RenderClock::advance(double wallSeconds, double cpuSeconds) {
  wall_ -= wallSeconds;
  cpu_ -= cpuSeconds;
}

RoundsResult runRounds(const RenderRequest& request, const RenderClock& clock, int groups,
                       const RoundsPlan& plan, const std::function<void(int, long long)>& work) {
  RoundsResult result;
  result.rounds = plan.begin;
  const auto made = [&] { return static_cast<double>(result.rounds - plan.begin); };
  const double start = clock.wallSeconds();
  const bool timed = plan.seconds > 0;
  const auto stopped = [&] { return request.stop && request.stop->load(); };
  const auto inFirstPass = [&] { return result.rounds < plan.roundsAPass; };
  const auto reached = [&](double limit) {
    const double elapsed = clock.wallSeconds();
    const double rounds = inFirstPass() ? 1 : static_cast<double>(plan.roundsAPass);
    const double next = rounds * (elapsed - start) / made();
    return agreed(request.ranks, elapsed + std::max(next / 2, next - kLate * limit) > limit);
  };
  const auto mayEnd = [&] { return inFirstPass() || result.rounds % plan.roundsAPass == 0; };
  std::size_t mark = 0;
  const Share own = shareOf(request.ranks, groups);
  const auto makeRounds = [&] {
    while (plan.rounds == 0 || result.rounds < plan.rounds) {
      // One round at least: an interruption never leaves an empty picture.
      if (made() > 0 && (plan.stopsInPass || mayEnd()) && stopped()) {
        result.interrupted = true;
        break;
      }
      if (timed && made() > 0 && mayEnd() && reached(plan.seconds)) break;
      if (result.rounds > 0 && plan.betweenRounds) plan.betweenRounds();
      parallelFor(request.threads, own.end - own.begin,
                  [&](int i) { work(own.begin + i, result.rounds); });
      if (plan.endOfRound) plan.endOfRound();
      ++result.rounds;
      if (request.progress) {
        const double now = clock.wallSeconds();
        const double done = static_cast<double>(result.rounds);
        const double fraction =
            plan.rounds > 0 ? done / static_cast<double>(plan.rounds) : now / plan.seconds;
        request.progress(
            {std::min(fraction, 1.0), now, made() * plan.unitsPerRound / (now - start), plan.unit});
      }
      if (plan.watch) plan.watch(result.rounds);
      if (!mayEnd()) continue;
      const auto passed = [&] {
        return timed ? reached(plan.marks[mark])
                     : static_cast<double>(result.rounds) >= plan.marks[mark];
      };
      for (; mark < plan.marks.size() && passed(); ++mark) plan.atMark(mark, result);
    }
    // A mark at the limit itself may not have been seen to be passed.
    if (!result.interrupted)
      for (; mark < plan.marks.size(); ++mark) plan.atMark(mark, result);
  };
  try {
    makeRounds();
  } catch (const RankLost&) {
    result.interrupted = true;
  }
  return result;
}

}  // namespace h2mc
