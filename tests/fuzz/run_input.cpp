// SPDX-License-Identifier: MIT
#include "run_input.h"

#include <cstdio>
#include <cstdlib>
#include <typeinfo>

#include "fuzz_target.h"
#include "render/core/user_error.h"

namespace h2mc::fuzz {
namespace {

[[noreturn]] void found(const char* kind, const char* what) {
  std::fprintf(stderr, "FINDING: %s: %s\n", kind, what);
  std::abort();
}

}  // namespace

std::string runInput(const std::string& input) {
  try {
    readInput(input);
  } catch (const UserError& e) {
    const std::string message = e.what();
    if (message.empty()) found("an error", "without a message");
    return message;
  } catch (const Finding& e) {
    found("the promise is broken", e.what());
  } catch (const std::exception& e) {
    found(typeid(e).name(), e.what());
  }
  return "";
}

}  // namespace h2mc::fuzz
