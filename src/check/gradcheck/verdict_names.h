// SPDX-License-Identifier: MIT
// What the reports call their verdicts.
#pragma once

#include "ad/derivative_check.h"
#include "check/gradcheck/gradcheck.h"
#include "render/core/index.h"

namespace h2mc {

constexpr const char* nameOf(ad::Verdict v) {
  constexpr const char* kNames[] = {"agrees", "difference noise", "kink nearby",
                                    "out of tolerance"};
  return kNames[at(v)];
}

constexpr const char* nameOf(FormVerdict v) {
  constexpr const char* kNames[] = {"agrees", "rounding", "not finite", "not supported",
                                    "out of tolerance"};
  return kNames[at(v)];
}

}  // namespace h2mc
