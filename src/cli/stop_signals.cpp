#include "cli/stop_signals.h"

#include <signal.h>
#include <unistd.h>

#include "cli/commands.h"
#include "render/image/atomic_file.h"

namespace h2mc {
namespace {

std::atomic<bool> stopRequested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "it is set in a signal handler");

struct sigaction previousInterrupt, previousTerminate;

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
  sigaction(SIGINT, &action, &previousInterrupt);
  sigaction(SIGTERM, &action, &previousTerminate);
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &previousInterrupt, nullptr);
  sigaction(SIGTERM, &previousTerminate, nullptr);
}

const std::atomic<bool>& StopSignals::requested() { return stopRequested; }

}  // namespace h2mc
