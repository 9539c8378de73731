// SPDX-License-Identifier: MIT
// What carries bytes between the processes of one render: MPI, in a module that is loaded where there are several
// (cli/join_ranks.h). A build without MPI has no module.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace h2mc {

class RankLink {
 public:
  virtual ~RankLink() = default;
  // This process's number, and how many there are.
  virtual int rank() const = 0;
  virtual int count() const = 0;
  // Into `all`, one after the other, what every rank has for the others, sizes[r] bytes of rank r: `own` has that many
  // of this one. To be called by all ranks alike. While the others are not there, calls goOn() again and again; returns
  // false where that has, or the connection has failed. Nothing more may be gathered then.
  virtual bool gather(const char* own, std::span<const std::size_t> sizes, char* all,
                      const std::function<bool()>& goOn) = 0;
  // Waits until all ranks have called it; the last call of all.
  virtual void leave() = 0;
};

// What the module defines under this name: null where the ranks can't be joined.
extern "C" RankLink* h2mcJoinRanks();

}  // namespace h2mc
