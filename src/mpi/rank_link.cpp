// SPDX-License-Identifier: MIT
// The module that joinRanks() loads (cli/join_ranks.h).
#include "render/integrator/rank_link.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <numeric>
#include <thread>
#include <vector>

namespace h2mc {
namespace {

// MPI counts in int.
constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
// MPI would wait on a whole core, which may be one that another rank computes on: after so many tries it is asked only
// so often.
constexpr int kTries = 2000;
constexpr std::chrono::microseconds kPause{50};

class MpiLink final : public RankLink {
 public:
  MpiLink() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  }

  int rank() const override { return rank_; }
  int count() const override { return count_; }

  bool gather(const char* own, std::span<const std::size_t> sizes, char* all,
              const std::function<bool()>& goOn) override {
    const auto ranks = static_cast<std::size_t>(count_);
    const std::size_t most = kMostAtOnce / ranks;
    const std::size_t largest = *std::max_element(sizes.begin(), sizes.end());
    std::vector<int> counts(ranks), places(ranks);
    std::vector<char> piece;
    // Pieces of what is too large, which lie apart in `all`.
    for (std::size_t done = 0; done < largest; done += most) {
      for (std::size_t r = 0; r < ranks; ++r)
        counts[r] = static_cast<int>(sizes[r] > done ? std::min(sizes[r] - done, most) : 0);
      std::exclusive_scan(counts.begin(), counts.end(), places.begin(), 0);
      char* to = all;
      if (largest > most) {
        piece.resize(static_cast<std::size_t>(places.back() + counts.back()));
        to = piece.data();
      }
      if (!gatherPiece(own + std::min(done, sizes[static_cast<std::size_t>(rank_)]), counts, places,
                       to, goOn))
        return false;
      if (largest <= most) break;
      char* place = all;
      for (std::size_t r = 0; r < ranks; place += sizes[r++])
        if (counts[r] > 0)
          std::memcpy(place + done, to + places[r], static_cast<std::size_t>(counts[r]));
    }
    return true;
  }

  void leave() override { MPI_Finalize(); }

 private:
  bool gatherPiece(const char* own, const std::vector<int>& counts, const std::vector<int>& places,
                   char* all, const std::function<bool()>& goOn) const {
    MPI_Request request{};
    if (MPI_Iallgatherv(own, counts[static_cast<std::size_t>(rank_)], MPI_BYTE, all, counts.data(),
                        places.data(), MPI_BYTE, MPI_COMM_WORLD, &request) != MPI_SUCCESS)
      return false;
    for (int tries = 0;; ++tries) {
      int done = 0;
      if (MPI_Test(&request, &done, MPI_STATUS_IGNORE) != MPI_SUCCESS) return false;
      if (done) return true;
      if (!goOn()) return false;
      if (tries < kTries)
        std::this_thread::yield();
      else
        std::this_thread::sleep_for(kPause);
    }
  }

  int rank_ = 0, count_ = 1;
};

}  // namespace

extern "C" RankLink* h2mcJoinRanks() {
  int provided = 0;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS ||
      provided < MPI_THREAD_FUNNELED)
    return nullptr;
  return new MpiLink;
}

}  // namespace h2mc
