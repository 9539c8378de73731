// SPDX-License-Identifier: MIT
#include "render/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
// Of what finds the gate itself, before it has entered there.
#define H2MC_BEFORE_GATE __attribute__((no_sanitize("thread")))
#else
#define H2MC_BEFORE_GATE
#endif

namespace h2mc {
namespace {

// ThreadSanitizer can't see how TBB's threads wait for one another, as the library is not compiled with it. So it is
// told: what a thread did before it passes a gate comes before what another does after it has entered there.
struct Gate {
#ifdef __SANITIZE_THREAD__
  void pass() { __tsan_release(this); }
  void enter() { __tsan_acquire(this); }
#else
  void pass() {}
  void enter() {}
#endif
};

}  // namespace

void parallelFor(int threads, int count, const std::function<void(int)>& work) {
  // More threads than TBB would start by itself, where somebody asks for them.
  std::optional<tbb::global_control> more;
  if (threads > tbb::this_task_arena::max_concurrency())
    more.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  Gate begin, end;
  begin.pass();
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, 1),
        [&](const tbb::blocked_range<int>& range) H2MC_BEFORE_GATE {
          begin.enter();
          for (int i = range.begin(); i < range.end(); ++i) work(i);
          end.pass();
        },
        tbb::simple_partitioner());
  });
  end.enter();
}

}  // namespace h2mc
