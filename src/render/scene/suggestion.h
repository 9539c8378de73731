// SPDX-License-Identifier: MIT
// Helps who mistyped a name: the closest names there are, and the list of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace h2mc {

// Names in a message's order.
using Names = std::vector<std::string>;

// The candidate that `name` is most likely meant to be; "" when none is close. Case and
// underscores do not count.
std::string closestName(std::string_view name, const Names& candidates);

// "did you mean "alpha"? available: alpha, distribution" ("available: none" without candidates).
std::string suggestion(std::string_view name, const Names& candidates);

// "a, b, c"
std::string joined(const Names& names);

// The snake_case spelling of Mitsuba 2/3: intIOR -> int_ior, toWorld -> to_world.
std::string snakeCase(std::string_view name);

std::string lowerCase(std::string_view text);

}  // namespace h2mc
