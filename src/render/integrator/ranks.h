// SPDX-License-Identifier: MIT
// One render by several processes, the ranks. All of them do the same, but for the groups of each round, which they
// share out: what the groups have made is brought together at the end of the round, and every rank adds all of it in
// the groups' order. So nothing depends on the number of ranks.
#pragma once

#include <atomic>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "render/integrator/rank_link.h"

namespace h2mc {

class Archive;

// A rank is gone or has failed: there will be nothing more from the others. what() says what is known of it.
class RankLost : public std::runtime_error {
 public:
  RankLost(const std::string& what, int exitCode) : std::runtime_error(what), exitCode_(exitCode) {}
  // That of the rank that has failed.
  int exitCode() const { return exitCode_; }

 private:
  int exitCode_;
};

// What is said "of all ranks" is to be called by all of them, the same calls in the same order, from one thread.
class Ranks {
 public:
  // `wish`: set when this process is asked to stop; keeps a reference. `patience`: for how many seconds it then waits
  // for the others, which may be gone.
  Ranks(std::unique_ptr<RankLink> link, const std::atomic<bool>& wish,
        std::function<double()> patience);

  int rank() const { return link_->rank(); }
  int count() const { return link_->count(); }
  // The one that writes files and talks.
  bool isFirst() const { return rank() == 0; }

  // Of all ranks: what each of them has to say, in their order. Throws RankLost.
  std::vector<std::string> gather(const std::string& own) { return exchange(own, kNoFailure); }
  // Of all ranks: the first one's value. Throws RankLost.
  template <class T>
  T agreed(T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::string bytes =
        gather({reinterpret_cast<const char*>(&value), isFirst() ? sizeof value : 0}).front();
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }

  // Set when any of the ranks was asked to stop, on all of them at the same point of their work; or when one is lost.
  const std::atomic<bool>& stop() const { return stop_; }
  // Whether RankLost was thrown.
  bool lost() const { return lost_; }
  // Whether a rank does not answer: then this process may only end itself. Otherwise it has to call leave().
  bool severed() const { return severed_; }

  // Instead of any other call: this rank fails, for this reason. Returns whether the others know, whose call throws
  // RankLost.
  bool fail(int exitCode, const std::string& why) noexcept;
  // Of all ranks; the last call.
  void leave() { link_->leave(); }

 private:
  static constexpr int kNoFailure = 0;
  std::vector<std::string> exchange(const std::string& own, int failure);
  void receive(const char* own, std::span<const std::size_t> sizes, char* all);
  [[noreturn]] void lose(const std::string& why, int exitCode);

  std::unique_ptr<RankLink> link_;
  const std::atomic<bool>& wish_;
  std::function<double()> patience_;
  std::atomic<bool> stop_{false};
  bool lost_ = false, severed_ = false;
  std::string why_;
  int exitCode_ = 0;
};

// The first rank's value; without ranks, the value. Throws RankLost.
template <class T>
T agreed(Ranks* ranks, T value) {
  return ranks ? ranks->agreed(value) : value;
}

// What a rank does of so many things: those from `begin` to `end`. All of them without ranks.
struct Share {
  int begin, end;
  bool has(int thing) const { return begin <= thing && thing < end; }
};
Share shareOf(const Ranks* ranks, int things);

// Of all ranks: each writes what shareOf() gives it of the things and reads all others. archive(a, i) writes or reads
// thing number i. Nothing without ranks. Throws RankLost, having read nothing.
void exchange(Ranks* ranks, int things, const std::function<void(Archive&, int)>& archive);

}  // namespace h2mc
