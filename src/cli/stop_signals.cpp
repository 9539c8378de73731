// SPDX-License-Identifier: MIT
#include "cli/stop_signals.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <array>

#include "cli/commands.h"
#include "render/image/atomic_file.h"

namespace h2mc {
namespace {

std::atomic<bool> stopRequested{false}, urgent{false};
static_assert(std::atomic<bool>::is_always_lock_free, "it is set in a signal handler");

// SIGHUP: the terminal, or the connection to it, is gone. The last one is of ranks alone.
constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGUSR1};
std::array<struct sigaction, kSignals.size()> previous;

// In milliseconds; may be called by a signal handler.
long long now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * 1000LL + time.tv_nsec / 1000000;
}

// A key that bounces, or a shell and a terminal that both pass a signal on, are no wish to lose the picture.
constexpr long long kSameWish = 1000;
std::atomic<long long> firstSignal{0};  // when it came; 0: not yet
// mpirun asks more than once, and has the last word anyway.
std::atomic<bool> oneIsEnough{false};
static_assert(std::atomic<long long>::is_always_lock_free, "as above");

void onSignal(int signal) {
  if (signal != SIGUSR1) urgent = true;
  const long long time = now();
  long long first = 0;
  if (firstSignal.compare_exchange_strong(first, time)) {
    stopRequested = true;
  } else if (!oneIsEnough && time - first > kSameWish) {
    removeTemporaryFiles();
    _exit(kFailed);
  }
}

}  // namespace

StopSignals::StopSignals(bool ofRanks) {
  stopRequested = false;
  urgent = false;
  oneIsEnough = ofRanks;
  firstSignal = 0;
  struct sigaction action = {};
  action.sa_handler = onSignal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &previous[i]);
    // What nohup has had ignored stays so; that a shell ignores SIGINT for jobs in the background does not.
    const bool wanted = kSignals[i] == SIGUSR1  ? ofRanks
                        : kSignals[i] == SIGHUP ? previous[i].sa_handler != SIG_IGN
                                                : true;
    if (wanted) sigaction(kSignals[i], &action, nullptr);
  }
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &previous[i], nullptr);
}

const std::atomic<bool>& StopSignals::requested() { return stopRequested; }

bool StopSignals::isUrgent() { return urgent; }

void StopSignals::request() {
  long long none = 0;
  firstSignal.compare_exchange_strong(none, now());
  stopRequested = true;
}

}  // namespace h2mc
