// SPDX-License-Identifier: MIT
#include "mcmc/mutations/step_sizes.h"

#include <gtest/gtest.h>

#include <sstream>

#include "render/core/archive.h"

namespace h2mc {
namespace {

// Counts of a kernel whose acceptance is 1 / (1 + c size) at path length i, c differing by the length.
class Kernel {
 public:
  static constexpr double kSlope[] = {1, 1, 0.3, 4, 1000, 1e-4};

  explicit Kernel(double wanted) : sizes(wanted), counts_(std::size(kSlope)) {}
  double acceptance(int length) const {
    return 1 / (1 + kSlope[length] * double(sizes.of(length)));
  }
  void epoch(long long proposals) {
    for (int i = 0; i < int(std::size(kSlope)); ++i) {
      counts_[std::size_t(i)].proposed += proposals;
      counts_[std::size_t(i)].expected += acceptance(i) * double(proposals);
    }
    sizes.learn(counts_);
  }
  StepSizes sizes;

 private:
  std::vector<AcceptanceCount> counts_;
};

TEST(StepSizes, FindTheAcceptanceForEachLength) {
  Kernel kernel(0.4);
  for (int epoch = 0; epoch < 12; ++epoch) kernel.epoch(1000);
  for (const int length : {1, 2, 3}) EXPECT_NEAR(kernel.acceptance(length), 0.4, 0.02) << length;
  // Where no size has it, the outermost.
  EXPECT_FLOAT_EQ(kernel.sizes.of(4), 1 / StepSizes::kLargest);
  EXPECT_FLOAT_EQ(kernel.sizes.of(5), StepSizes::kLargest);
  EXPECT_EQ(kernel.sizes.of(32), 1) << "lengths that were never met";
}

TEST(StepSizes, ChangeByWhatWasNew) {
  Kernel kernel(0.4);
  kernel.epoch(1000);
  const float first = kernel.sizes.of(3);
  EXPECT_LT(first, 1);
  kernel.epoch(10);
  EXPECT_EQ(kernel.sizes.of(3), first) << "too few to say anything";
  kernel.epoch(395);
  EXPECT_NE(kernel.sizes.of(3), first) << "together they are enough";
}

TEST(StepSizes, StayWhereNobodyAsks) {
  Kernel kernel(0);
  for (int epoch = 0; epoch < 5; ++epoch) kernel.epoch(1000);
  for (int length = 0; length < 6; ++length) EXPECT_EQ(kernel.sizes.of(length), 1);
}

TEST(StepSizes, GoOnFromAnArchive) {
  Kernel kernel(0.4);
  kernel.epoch(1000);
  std::stringstream stream;
  Archive out(stream);
  kernel.sizes.archive(out);
  const auto size = static_cast<std::uint64_t>(stream.tellp());
  StepSizes again(0.4);
  Archive in(stream, size);
  again.archive(in);
  EXPECT_EQ(again.of(3), kernel.sizes.of(3));
}

}  // namespace
}  // namespace h2mc
