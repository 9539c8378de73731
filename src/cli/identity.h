// SPDX-License-Identifier: MIT
// What decides on a picture: by it checkpoints know their render, and images those they may be averaged with.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "render/scene/option_set.h"

namespace h2mc {

struct Scene;

// How a scene was read, besides its files.
struct SceneReading {
  std::map<std::string, std::string> defines;
  bool permissive = false;
};

// What decides on a picture but for the budget and the number of threads: program, scene with the contents of all its
// files, size, integrator with its options, seed. Throws InputError if a file can't be read.
nlohmann::json identityOf(const Scene& scene, const SceneReading& reading,
                          const OptionSet& integrator, std::uint64_t seed);

// Of an identity: the scene's files and how they were read, in 8 hexadecimal digits. Files count by their place as seen
// from `sceneFile`: a copy of the whole folder has the same.
std::string sceneDigest(const nlohmann::json& identity, const std::string& sceneFile);

// Whether an integrator's option is its budget, which decides on how good a picture is and not on which.
bool isBudget(std::string_view option);

// CRC-32 of the first `size` bytes; 0 and a failed stream if there are fewer.
std::uint32_t checksumOf(std::istream& stream, std::uint64_t size);

}  // namespace h2mc
