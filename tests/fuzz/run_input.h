// SPDX-License-Identifier: MIT
// One input, read, and what came of it.
#pragma once

#include <string>

namespace h2mc::fuzz {

// What a reader has said: its message, "" where it has read the input. Aborts, after saying why on stderr, where the
// input is a finding; the driver keeps it.
std::string runInput(const std::string& input);

}  // namespace h2mc::fuzz
