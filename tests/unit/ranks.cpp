// SPDX-License-Identifier: MIT
// Renders by several ranks, which are threads here.
#include "render/integrator/ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>

#include "render/core/archive.h"
#include "render/core/index.h"
#include "tiny_render.h"

namespace h2mc {
namespace {

// What the threads share: the next of them that gathers waits until all have.
class Meeting {
 public:
  explicit Meeting(int count) : own_(at(count)) {}
  int count() const { return static_cast<int>(own_.size()); }

  bool gather(int rank, std::string own, char* all, const std::function<bool()>& goOn) {
    std::unique_lock lock(mutex_);
    const long long number = number_;
    own_[at(rank)] = std::move(own);
    if (++there_ == count()) {
      there_ = 0;
      ++number_;
      all_.clear();
      for (const std::string& one : own_) all_ += one;
    }
    while (number_ == number) {
      lock.unlock();
      if (!goOn()) return false;
      std::this_thread::sleep_for(std::chrono::microseconds(20));
      lock.lock();
    }
    std::copy(all_.begin(), all_.end(), all);
    return true;
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> own_;
  std::string all_;
  int there_ = 0;
  long long number_ = 0;
};

class ThreadLink final : public RankLink {
 public:
  ThreadLink(Meeting& meeting, int rank) : meeting_(meeting), rank_(rank) {}
  int rank() const override { return rank_; }
  int count() const override { return meeting_.count(); }
  bool gather(const char* own, std::span<const std::size_t> sizes, char* all,
              const std::function<bool()>& goOn) override {
    return meeting_.gather(rank_, {own, sizes[at(rank_)]}, all, goOn);
  }
  void leave() override {}

 private:
  Meeting& meeting_;
  int rank_;
};

// Calls work(ranks, wish) on each of so many, `wish` being what asks it to stop.
void onRanks(int count, const std::function<void(Ranks&, std::atomic<bool>&)>& work) {
  Meeting meeting(count);
  std::vector<std::thread> threads;
  for (int rank = 0; rank < count; ++rank)
    threads.emplace_back([&, rank] {
      std::atomic<bool> wish{false};
      Ranks ranks(std::make_unique<ThreadLink>(meeting, rank), wish, [] { return 0.5; });
      work(ranks, wish);
    });
  for (std::thread& thread : threads) thread.join();
}

TEST(Ranks, BringTogetherWhatEachHas) {
  onRanks(3, [](Ranks& ranks, std::atomic<bool>&) {
    for (const std::size_t size : {0, 1, 46, 47, 5000}) {
      const auto of = [&](int rank) {
        return std::string(size * at(rank) / 2, static_cast<char>('a' + rank));
      };
      const std::vector<std::string> all = ranks.gather(of(ranks.rank()));
      EXPECT_EQ(all, (std::vector<std::string>{of(0), of(1), of(2)}));
    }
    EXPECT_EQ(ranks.agreed(7 + ranks.rank()), 7);
    EXPECT_EQ(agreed<double>(nullptr, 3), 3);

    for (const int things : {0, 2, 11}) {
      std::vector<int> values(at(things));
      const Share own = shareOf(&ranks, things);
      for (int i = own.begin; i < own.end; ++i) values[at(i)] = 10 + i;
      exchange(&ranks, things, [&](Archive& archive, int i) { archive(values[at(i)]); });
      for (int i = 0; i < things; ++i) EXPECT_EQ(values[at(i)], 10 + i);
    }
  });
}

TEST(Ranks, StopTogether) {
  onRanks(3, [](Ranks& ranks, std::atomic<bool>& wish) {
    ranks.gather("");
    EXPECT_FALSE(ranks.stop());
    if (ranks.rank() == 1) wish = true;
    EXPECT_FALSE(ranks.stop());
    ranks.gather("");
    EXPECT_TRUE(ranks.stop());
    ranks.gather("");
    EXPECT_FALSE(ranks.lost());
  });
}

TEST(Ranks, KnowWhenOneFails) {
  onRanks(3, [](Ranks& ranks, std::atomic<bool>&) {
    if (ranks.rank() == 2) {
      EXPECT_TRUE(ranks.fail(2, "there is no scene"));
      return;
    }
    try {
      ranks.gather(std::string(100, 'x'));
      ADD_FAILURE();
    } catch (const RankLost& e) {
      EXPECT_STREQ(e.what(), "rank 2: there is no scene");
      EXPECT_EQ(e.exitCode(), 2);
    }
    EXPECT_TRUE(ranks.stop() && ranks.lost() && !ranks.severed());
    EXPECT_THROW(ranks.agreed(1), RankLost);
  });
}

// Who is to stop does not wait for who is gone; whoever is not asked, waits.
TEST(Ranks, DoNotWaitForTheDead) {
  onRanks(3, [](Ranks& ranks, std::atomic<bool>& wish) {
    ranks.gather("");
    if (ranks.rank() == 1) return;
    wish = true;
    EXPECT_THROW(ranks.gather(""), RankLost);
    EXPECT_TRUE(ranks.severed() && ranks.stop());
  });
}

class RanksRender : public ::testing::TestWithParam<const char*> {
 protected:
  static RenderRequest request() {
    RenderRequest r;
    r.budget.mutationsPerPixel = 60;
    r.seed = 5;
    r.threads = 1;
    r.pixelStatistics = {true, true};
    return r;
  }
  static RenderResult render(const Scene& scene, const RenderRequest& request) {
    return test::renderTiny(GetParam(), scene, request, {{"maxDepth", "5"}});
  }
};

TEST_P(RanksRender, MakeTheSameImage) {
  const Scene scene = test::tinyRing();
  const RenderResult alone = render(scene, request());
  for (const int count : {2, 5})
    onRanks(count, [&](Ranks& ranks, std::atomic<bool>&) {
      RenderRequest r = request();
      r.ranks = &ranks;
      r.stop = &ranks.stop();
      const RenderResult result = render(scene, r);
      EXPECT_EQ(result.image.pixels, alone.image.pixels);
      EXPECT_EQ(result.variance.pixels, alone.variance.pixels);
      EXPECT_EQ(result.counts, alone.counts);
      EXPECT_EQ(result.samples, alone.samples);
      EXPECT_EQ(result.meanLuminance, alone.meanLuminance);
      EXPECT_EQ(result.meanLuminanceError, alone.meanLuminanceError);
      EXPECT_FALSE(result.interrupted);
    });
}

// One of them is gone in the middle. The picture of the others is whole up to there: as bright as it should be.
TEST_P(RanksRender, GoesOnWithoutOneThatIsLost) {
  const Scene scene = test::tinyRing();
  const double mean = render(scene, request()).meanLuminance;
  onRanks(3, [&](Ranks& ranks, std::atomic<bool>& wish) {
    RenderRequest r = request();
    r.budget.mutationsPerPixel = 100000;
    r.ranks = &ranks;
    r.stop = &ranks.stop();
    struct Gone {};
    int looked = 0;
    r.watch = [&](RenderInProgress& now) {
      if (now.result().samples == 0 || ++looked < 40) return;
      if (ranks.rank() == 2) throw Gone();
      wish = true;
    };
    try {
      const RenderResult result = render(scene, r);
      EXPECT_TRUE(result.interrupted && ranks.severed());
      double sum = 0;
      for (const Rgbf& pixel : result.image.pixels) sum += luminance(pixel);
      EXPECT_NEAR(sum / static_cast<double>(result.image.pixels.size()) / mean, 1, 0.5);
      EXPECT_NEAR(result.meanLuminance / mean, 1, 0.5);
      // Of the round that was dropped nothing is counted.
      if (result.sampleUnit == "samples") {
        EXPECT_EQ(at(result.samples) % result.image.pixels.size(), 0u);
      }
    } catch (const Gone&) {
      EXPECT_EQ(ranks.rank(), 2);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Integrators, RanksRender,
                         ::testing::Values("path", "bdpt", "mmlt", "h2mc", "lmc", "remlt", "erpt",
                                           "restore"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace h2mc
