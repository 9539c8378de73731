// SPDX-License-Identifier: MIT
// Changes of a scene file that leave it XML, so that they come to what the reader makes of it.
#pragma once

#include <string>

#include "byte_mutator.h"

namespace h2mc::fuzz {

// One change or some more. Text that is no XML goes to `mutateBytes`, and now and then other text too.
std::string mutateScene(const std::string& text, Random& random, const ByteMutator& mutateBytes,
                        std::size_t most);

}  // namespace h2mc::fuzz
