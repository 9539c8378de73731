// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace h2mc {

// Something that the user gave is wrong; what() says what was expected, what there is, and where. The program ends
// with exit code 2.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace h2mc
