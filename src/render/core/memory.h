// SPDX-License-Identifier: MIT
// How much memory there is, so that what can't fit is refused before it is begun.
#pragma once

#include <string>

#include "render/core/user_error.h"

namespace h2mc {

// Something needs more memory than there is; what() is the whole message.
class MemoryError : public UserError {
 public:
  using UserError::UserError;
};

struct MemoryLeft {
  double bytes = 0;    // that may still be taken
  std::string source;  // who says so: "this machine", "the control group", "--max-memory"
};

// Of the limit that setMostMemory() has given, less what the process has; without one, the least of what the machine,
// its control groups and its address space leave. Infinite where none of them says.
MemoryLeft memoryLeft();

// What the process may have in all, in bytes; 0: what there is. Call it before other threads start.
void setMostMemory(double bytes);

// Throws MemoryError where `bytes` are more than memoryLeft(). `what`: the message's subject, "a film of ...";
// `remedy`: what to change, "expected a smaller --width".
void requireMemory(double bytes, const std::string& what, const std::string& remedy);

// What the control groups that the process is in, and those above them, leave of their limits, in bytes; infinite where
// there is none. Version 1 and 2; `root` stands before /proc and /sys (for tests).
double memoryLeftInGroups(const std::string& root = "");

}  // namespace h2mc
