// SPDX-License-Identifier: MIT
// Work in groups and rounds: the same image whatever the number of threads.
#pragma once

#include <functional>

#include "render/core/parallel.h"
#include "render/integrator/integrator.h"

namespace h2mc {

// How many groups so many units of work are split into, each at least some tenths of a millisecond long: the
// number of threads that can be busy. What groups add up is added in their order, so the number must not
// depend on that of the threads.
int groupCount(long long units);
inline constexpr int kMostGroups = 256;

// The time that a render takes, less what does not belong to it.
class RenderClock {
 public:
  RenderClock();  // starts it
  double wallSeconds() const;
  double cpuSeconds() const;
  // Calls work() without counting its time: the clock stands still meanwhile.
  void exclude(const std::function<void()>& work);
  // As if it had been started so much earlier.
  void advance(double wallSeconds, double cpuSeconds);

 private:
  double wall_, cpu_;  // when it would have been started without the exclusions
  bool stands_ = false;
  double standsWall_ = 0, standsCpu_ = 0;  // where it stands
};

struct RoundsResult {
  long long rounds = 0;  // completed
  bool interrupted = false;
};

struct RoundsPlan {
  long long rounds = 0;  // 0: until the time is up
  long long begin = 0;   // rounds of these that were made before
  double seconds = 0;    // on the clock; 0: until the rounds are done
  // So many rounds make one pass. The first may be cut short by the time or the stop flag, later ones are completed
  // (but for the stop flag where stopsInPass says so), and marks lie between them.
  long long roundsAPass = 1;
  bool stopsInPass = false;
  double unitsPerRound = 1;
  std::string unit;
  // Ascending, in rounds or, where the plan is a time, in seconds; atMark is called once for each that
  // is reached, in order. It may exclude its time from the clock.
  std::vector<double> marks;
  std::function<void(std::size_t mark, const RoundsResult&)> atMark;
  // Called at the end of each round, when all groups are done; may be empty.
  std::function<void()> endOfRound;
  // Called between one round and the next; may be empty.
  std::function<void()> betweenRounds;
  // Called after each round: how many there were; may be empty.
  std::function<void(long long rounds)> watch;
};

// Calls work(group, round) for all groups of a round in parallel, round after round, until the plan
// is fulfilled or the request's stop flag is set. One round is made at least, if the plan has one, and a started one is
// completed: all groups have done the same number of rounds when it returns.
// Ranks share out the groups of each round: endOfRound has to bring together what they have made, and throws RankLost
// where it can't, which is an interruption before that round.
// The clock may have run before: its time counts. A time is reached where one more round, or pass, would end
// further from it than we are now, or end later than it by more than a twentieth.
RoundsResult runRounds(const RenderRequest& request, const RenderClock& clock, int groups,
                       const RoundsPlan& plan,
                       const std::function<void(int group, long long round)>& work);

// Seconds since some fixed point, and of processor time this process has used.
double wallClock();
double cpuClock();

}  // namespace h2mc
