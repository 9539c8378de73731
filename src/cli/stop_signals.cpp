// SPDX-License-Identifier: MIT
#include "cli/stop_signals.h"

#include <signal.h>
#include <unistd.h>

#include <array>

#include "cli/commands.h"
#include "render/image/atomic_file.h"

namespace h2mc {
namespace {

std::atomic<bool> stopRequested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "it is set in a signal handler");

// SIGHUP: the terminal, or the connection to it, is gone.
constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
std::array<struct sigaction, kSignals.size()> previous;

void onSignal(int) {
  if (stopRequested.exchange(true)) {
    removeTemporaryFiles();
    _exit(kInterrupted);
  }
}

}  // namespace

StopSignals::StopSignals() {
  stopRequested = false;
  struct sigaction action = {};
  action.sa_handler = onSignal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &previous[i]);
    // What nohup has had ignored stays so; that a shell ignores SIGINT for jobs in the background does not.
    if (kSignals[i] != SIGHUP || previous[i].sa_handler != SIG_IGN)
      sigaction(kSignals[i], &action, nullptr);
  }
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &previous[i], nullptr);
}

const std::atomic<bool>& StopSignals::requested() { return stopRequested; }

}  // namespace h2mc
