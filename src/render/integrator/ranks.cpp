// SPDX-License-Identifier: MIT
#include "render/integrator/ranks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <sstream>

#include "render/core/archive.h"
#include "render/core/index.h"
#include "render/integrator/parallel_rounds.h"

namespace h2mc {
namespace {

// What goes first, of every rank: what is short is there already.
struct Header {
  std::uint64_t size = 0;
  std::uint8_t stop = 0;
  std::uint8_t failure = 0;  // exit code
  std::array<char, 46> begin{};
};
static_assert(sizeof(Header) == 56);

// Of those that have all agreed to stop: they were there a moment ago, and may be busy with a checkpoint.
constexpr double kPatienceOnceAgreed = 30;
constexpr int kFailedExitCode = 3;

Share shareOf(int rank, int ranks, int things) {
  const auto upTo = [&](long long r) { return static_cast<int>(things * r / ranks); };
  return {upTo(rank), upTo(rank + 1)};
}

}  // namespace

Ranks::Ranks(std::unique_ptr<RankLink> link, const std::atomic<bool>& wish,
             std::function<double()> patience)
    : link_(std::move(link)), wish_(wish), patience_(std::move(patience)) {}

void Ranks::lose(const std::string& why, int exitCode) {
  lost_ = true;
  stop_ = true;
  why_ = why;
  exitCode_ = exitCode;
  throw RankLost(why_, exitCode_);
}

void Ranks::receive(const char* own, std::span<const std::size_t> sizes, char* all) {
  double asked = 0;
  const auto goOn = [&] {
    if (!wish_) return true;
    const double now = wallClock();
    if (asked == 0) asked = now;
    return now - asked < (stop_ ? kPatienceOnceAgreed : patience_());
  };
  if (link_->gather(own, sizes, all, goOn)) return;
  severed_ = true;
  lose("a rank does not answer any more", kFailedExitCode);
}

std::vector<std::string> Ranks::exchange(const std::string& own, int failure) {
  if (lost_) throw RankLost(why_, exitCode_);
  const auto ranks = at(count());
  Header header;
  header.size = own.size();
  header.stop = wish_;
  header.failure = static_cast<std::uint8_t>(failure);
  std::copy_n(own.begin(), std::min(own.size(), header.begin.size()), header.begin.begin());
  std::vector<Header> headers(ranks);
  receive(reinterpret_cast<const char*>(&header), std::vector<std::size_t>(ranks, sizeof(Header)),
          reinterpret_cast<char*>(headers.data()));

  std::vector<std::string> all;
  std::vector<std::size_t> sizes;
  bool more = false;
  for (const Header& of : headers) {
    sizes.push_back(of.size);
    more |= of.size > of.begin.size();
    all.emplace_back(of.begin.data(), std::min<std::size_t>(of.size, of.begin.size()));
    if (of.stop) stop_ = true;
  }
  if (more) {
    std::vector<char> bytes(std::reduce(sizes.begin(), sizes.end()));
    receive(own.data(), sizes, bytes.data());
    const char* from = bytes.data();
    for (std::size_t r = 0; r < ranks; from += sizes[r++]) all[r].assign(from, sizes[r]);
  }
  for (std::size_t r = 0; r < ranks; ++r)
    if (headers[r].failure != kNoFailure)
      lose("rank " + std::to_string(r) + ": " + all[r], headers[r].failure);
  return all;
}

bool Ranks::fail(int exitCode, const std::string& why) noexcept {
  if (lost_) return !severed_;
  try {
    exchange(why, exitCode);
  } catch (const std::exception&) {
    return !severed_;
  }
  return true;
}

Share shareOf(const Ranks* ranks, int things) {
  return ranks ? shareOf(ranks->rank(), ranks->count(), things) : Share{0, things};
}

void exchange(Ranks* ranks, int things, const std::function<void(Archive&, int)>& archive) {
  if (!ranks) return;
  const Share own = shareOf(ranks, things);
  std::ostringstream written;
  Archive to(written);
  for (int i = own.begin; i < own.end; ++i) archive(to, i);
  std::vector<std::string> all = ranks->gather(std::move(written).str());
  for (int rank = 0; rank < ranks->count(); ++rank) {
    if (rank == ranks->rank()) continue;
    const std::size_t size = all[at(rank)].size();
    std::istringstream read(std::move(all[at(rank)]));
    Archive from(read, size);
    const Share share = shareOf(rank, ranks->count(), things);
    for (int i = share.begin; i < share.end; ++i) archive(from, i);
    if (from.left() > 0) throw std::logic_error("ranks do not tell each other the same");
  }
}

}  // namespace h2mc
