// SPDX-License-Identifier: MIT
// What a fuzz target is: a reader that is given an input, and a way to make further inputs. Each target defines the
// functions in a file of its own, which is linked with one of two drivers: libfuzzer_driver.cpp, or seeded_driver.cpp
// where there is no libFuzzer.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "byte_mutator.h"

namespace h2mc::fuzz {

// A property that the target promises and an input breaks. Not a UserError: these are a reader's right answer.
class Finding : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

// Reads the input. Throws UserError where it is refused, which is as good as reading it. Whatever else is thrown is a
// finding, and so are a crash, a sanitizer's report, and more than the driver's time and memory.
void readInput(const std::string& input);

// One of the inputs that lie near this one, at most `most` bytes long. `mutateBytes` changes any text a little.
std::string mutateInput(const std::string& input, Random& random, const ByteMutator& mutateBytes,
                        std::size_t most);

// Words of the format, for the mutator of bytes.
std::span<const std::string_view> words();

}  // namespace h2mc::fuzz
