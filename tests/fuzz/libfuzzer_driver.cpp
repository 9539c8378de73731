// SPDX-License-Identifier: MIT
// A target as libFuzzer runs it: with inputs that lead to new branches of the code.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "fuzz_target.h"
#include "run_input.h"

// libFuzzer's names.
extern "C" {
std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned seed);
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  h2mc::fuzz::runInput({reinterpret_cast<const char*>(data), size});
  return 0;
}

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned seed) {
  using namespace h2mc::fuzz;
  Random random(seed);
  // Its own mutator knows which bytes were compared with what, ours the format's words.
  const ByteMutator bytes = [&](std::string text, std::size_t longest) {
    if (random.chance(0.5)) return mutateBytes(std::move(text), words(), random, longest);
    const std::size_t length = std::min(text.size(), longest);
    text.resize(std::max<std::size_t>(longest, 1));
    text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), length, longest));
    return text;
  };
  std::string changed =
      mutateInput({reinterpret_cast<const char*>(data), size}, random, bytes, most);
  if (changed.size() > most) changed.resize(most);
  std::copy(changed.begin(), changed.end(), data);
  return changed.size();
}
