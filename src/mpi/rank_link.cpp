// SPDX-License-Identifier: MIT
// The module that joinRanks() loads (cli/join_ranks.h).
#include "render/integrator/rank_link.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <memory>
#include <mutex>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

namespace h2mc {
namespace {

// MPI counts in int.
constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
// MPI would wait on a whole core, which may be one that another rank computes on: after so many tries it is asked only
// so often.
constexpr int kTries = 2000;
constexpr std::chrono::microseconds kPause{50};

// What one rank has asked its MPI thread for.
struct Job {
  std::vector<std::size_t> sizes;  // of each rank; none: to leave
  std::vector<char> own, all;
  bool succeeded = false;
};

// All calls of MPI are made by a thread of their own, and no data are the caller's. Where another rank is gone, Open
// MPI may never return from the call in which it finds that out: 4.1 waits there for mpirun to take down a message.
// The caller has a picture to write by then.
class MpiThread {
 public:
  // Of the thread, which ends with a job to leave. Tells what MPI_Init_thread says.
  void run() {
    int provided = 0;
    bool well = MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided) == MPI_SUCCESS &&
                provided >= MPI_THREAD_FUNNELED;
    if (well) {
      MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
      MPI_Comm_size(MPI_COMM_WORLD, &count_);
      MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    }
    std::unique_lock lock(mutex_);
    done_ = true;
    job_.succeeded = well;
    for (bool leaves = !well; !leaves;) {
      changed_.notify_all();
      changed_.wait(lock, [&] { return !done_; });
      leaves = job_.sizes.empty();
      lock.unlock();
      if (leaves)
        MPI_Finalize();
      else
        well = gather();
      lock.lock();
      job_.succeeded = well;
      done_ = true;
    }
    changed_.notify_all();
  }

  // Of the caller: what was asked for last, once it is done; null as soon as goOn() says no, after which nothing more
  // may be asked for.
  Job* wait(const std::function<bool()>& goOn) {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, kLook, [&] { return done_; }))
      if (!goOn()) {
        givenUp_ = true;
        return nullptr;
      }
    return &job_;
  }
  // Precondition: the last one is done.
  void ask(std::vector<std::size_t> sizes, const char* own) {
    const std::lock_guard lock(mutex_);
    job_.sizes = std::move(sizes);
    if (!job_.sizes.empty()) {
      job_.own.assign(own, own + job_.sizes[static_cast<std::size_t>(rank_)]);
      job_.all.resize(std::reduce(job_.sizes.begin(), job_.sizes.end()));
    }
    done_ = false;
    changed_.notify_all();
  }
  int rank() const { return rank_; }
  int count() const { return count_; }

 private:
  // How often the caller looks whether it is to go on.
  static constexpr std::chrono::milliseconds kLook{20};

  bool gather() {
    const auto ranks = static_cast<std::size_t>(count_);
    const std::size_t most = kMostAtOnce / ranks;
    const std::vector<std::size_t>& sizes = job_.sizes;
    const std::size_t largest = *std::max_element(sizes.begin(), sizes.end());
    std::vector<int> counts(ranks), places(ranks);
    std::vector<char> piece;
    // Pieces of what is too large, which lie apart in `all`.
    for (std::size_t done = 0; done < largest; done += most) {
      for (std::size_t r = 0; r < ranks; ++r)
        counts[r] = static_cast<int>(sizes[r] > done ? std::min(sizes[r] - done, most) : 0);
      std::exclusive_scan(counts.begin(), counts.end(), places.begin(), 0);
      char* to = job_.all.data();
      if (largest > most) {
        piece.resize(static_cast<std::size_t>(places.back()) +
                     static_cast<std::size_t>(counts.back()));
        to = piece.data();
      }
      if (!gatherPiece(job_.own.data() + std::min(done, job_.own.size()), counts, places, to))
        return false;
      if (largest <= most) break;
      char* place = job_.all.data();
      for (std::size_t r = 0; r < ranks; place += sizes[r++])
        if (counts[r] > 0)
          std::memcpy(place + done, to + places[r], static_cast<std::size_t>(counts[r]));
    }
    return true;
  }

  bool gatherPiece(const char* own, const std::vector<int>& counts, const std::vector<int>& places,
                   char* all) const {
    MPI_Request request{};
    if (MPI_Iallgatherv(own, counts[static_cast<std::size_t>(rank_)], MPI_BYTE, all, counts.data(),
                        places.data(), MPI_BYTE, MPI_COMM_WORLD, &request) != MPI_SUCCESS)
      return false;
    for (int tries = 0; !givenUp_; ++tries) {
      int done = 0;
      if (MPI_Test(&request, &done, MPI_STATUS_IGNORE) != MPI_SUCCESS) return false;
      if (done) return true;
      if (tries < kTries)
        std::this_thread::yield();
      else
        std::this_thread::sleep_for(kPause);
    }
    return false;
  }

  int rank_ = 0, count_ = 1;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<bool> givenUp_{false};
  bool done_ = false;  // job_ is the caller's; before, the thread's
  Job job_;
};

class MpiLink final : public RankLink {
 public:
  // Whether MPI has begun.
  bool begin() {
    std::thread([thread = thread_] { thread->run(); }).detach();
    return thread_->wait([] { return true; })->succeeded;
  }

  int rank() const override { return thread_->rank(); }
  int count() const override { return thread_->count(); }

  bool gather(const char* own, std::span<const std::size_t> sizes, char* all,
              const std::function<bool()>& goOn) override {
    thread_->ask({sizes.begin(), sizes.end()}, own);
    const Job* const job = thread_->wait(goOn);
    if (!job || !job->succeeded) return false;
    std::copy(job->all.begin(), job->all.end(), all);
    return true;
  }

  void leave() override {
    thread_->ask({}, nullptr);
    thread_->wait([] { return true; });
  }

 private:
  std::shared_ptr<MpiThread> thread_ = std::make_shared<MpiThread>();
};

}  // namespace

extern "C" RankLink* h2mcJoinRanks() {
  auto link = std::make_unique<MpiLink>();
  return link->begin() ? link.release() : nullptr;
}

}  // namespace h2mc
