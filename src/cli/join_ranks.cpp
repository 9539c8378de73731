// SPDX-License-Identifier: MIT
#include "cli/join_ranks.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <string_view>
#include <thread>

#include "cli/commands.h"
#include "cli/stop_signals.h"

namespace h2mc {
namespace {

std::optional<int> number(const char* variable) {
  const char* const text = std::getenv(variable);
  if (!text) return std::nullopt;
  const std::string_view all = text;
  int value = 0;
  const auto [end, error] = std::from_chars(all.data(), all.data() + all.size(), value);
  if (error != std::errc() || end != all.data() + all.size() || value < 0) return std::nullopt;
  return value;
}

// Where a rank is gone the others get SIGTERM, and soon after SIGKILL, by when the image has to be written: by mpirun
// in a second, if it has not been told otherwise, by srun in 30.
double patience() {
  if (!StopSignals::isUrgent()) return 60;
  if (const auto seconds = number("OMPI_MCA_odls_base_sigkill_timeout"))
    return std::max(0.3, *seconds / 3.);
  return number("OMPI_COMM_WORLD_SIZE") ? 0.3 : 10;
}

RankLink* linkOfModule(const RankPlace& place) {
  const std::string who =
      fmt::format("{} processes were started to render together, but ", place.count);
#ifdef H2MC_MPI_MODULE
  // Looked for as image_formats.cpp does. MPI loads modules of its own, which look for its names among all.
  void* const module = dlopen(H2MC_MPI_MODULE, RTLD_NOW | RTLD_GLOBAL);
  void* const entry = module ? dlsym(module, "h2mcJoinRanks") : nullptr;
  if (!entry) throw InputError(who + "the module for that does not load: " + dlerror());
  RankLink* const link = reinterpret_cast<decltype(&h2mcJoinRanks)>(entry)();
  if (!link) throw InputError(who + "MPI does not begin");
  return link;
#else
  throw InputError(who +
                   "this build renders by one alone: it was made without MPI (Debian's "
                   "libopenmpi-dev and pkg-config)");
#endif
}

}  // namespace

// Of Open MPI's mpirun; of others, and srun --mpi=pmi2; of srun --mpi=pmix.
RankPlace rankPlace() {
  const auto place = [](const char* rank, const char* count) -> std::optional<RankPlace> {
    const std::optional<int> r = number(rank), n = number(count);
    if (!r || !n) return std::nullopt;
    return RankPlace{*r, *n};
  };
  if (const auto found = place("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE")) return *found;
  if (const auto found = place("PMI_RANK", "PMI_SIZE")) return *found;
  if (const auto found = place("PMIX_RANK", "SLURM_STEP_NUM_TASKS")) return *found;
  return {};
}

void letFirstEnd() {
  constexpr std::chrono::seconds kOthersStay{10};
  if (!rankPlace().talks()) std::this_thread::sleep_for(kOthersStay);
}

std::unique_ptr<Ranks> joinRanks() {
  const RankPlace place = rankPlace();
  if (place.alone()) return nullptr;
  std::unique_ptr<RankLink> link(linkOfModule(place));
  if (link->count() != place.count)
    throw InputError(
        fmt::format("{} processes were started to render together, but by another MPI than this "
                    "build's, which sees {}",
                    place.count, link->count()));
  return std::make_unique<Ranks>(std::move(link), StopSignals::requested(), patience);
}

int runOnRanks(Ranks& ranks, const std::function<int()>& work) {
  const auto say = [](const char* what) { std::fprintf(stderr, "h2mc: %s\n", what); };
  const auto failed = [&](int exitCode, const char* what) {
    const bool told = ranks.fail(exitCode, what);
    if (ranks.isFirst() || !told) say(what);
    return exitCode;
  };
  int exitCode = kFailed;
  try {
    exitCode = work();
  } catch (const RankLost& e) {
    exitCode = e.exitCode();
    if (ranks.isFirst()) say(e.what());
  } catch (const UserError& e) {
    exitCode = failed(kBadInput, e.what());
  } catch (const std::bad_alloc&) {
    exitCode = failed(kFailed, "out of memory");
  } catch (const std::exception& e) {
    exitCode = failed(kFailed, e.what());
  }
  if (ranks.severed()) {
    // MPI would wait for who is gone.
    letFirstEnd();
    std::fflush(nullptr);
    _exit(exitCode);
  }
  ranks.leave();
  return exitCode;
}

}  // namespace h2mc
