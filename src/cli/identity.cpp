// SPDX-License-Identifier: MIT
#include "cli/identity.h"

#include <fmt/format.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "cli/commands.h"
#include "h2mc_version.h"
#include "render/core/index.h"
#include "render/core/input_file.h"
#include "render/scene/scene.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Each file's name as the scene has it, and the CRC-32 of what is in it.
json contentsOf(const std::vector<std::string>& files) {
  json contents = json::object();
  for (const std::string& file : files) {
    const std::uint64_t size = InputFile(file, kLargestData).size();
    std::ifstream stream(file, std::ios::binary);
    const std::uint32_t sum = checksumOf(stream, size);
    if (!stream) throw InputError("cannot read \"" + file + "\"");
    contents[file] = fmt::format("{:08x}", sum);
  }
  return contents;
}

}  // namespace

std::uint32_t checksumOf(std::istream& stream, std::uint64_t size) {
  std::vector<char> block(1 << 20);
  uLong sum = 0;
  while (size > 0) {
    const auto now = std::min<std::uint64_t>(size, block.size());
    if (!stream.read(block.data(), static_cast<std::streamsize>(now))) return 0;
    sum = crc32_z(sum, reinterpret_cast<const unsigned char*>(block.data()), now);
    size -= now;
  }
  return static_cast<std::uint32_t>(sum);
}

bool isBudget(std::string_view option) {
  return option == "mutationsPerPixel" || option == "samplesPerPixel";
}

json identityOf(const Scene& scene, const SceneReading& reading, const OptionSet& integrator,
                std::uint64_t seed) {
  json options = json::object();
  for (const auto& [name, value] : integrator.values())
    if (!isBudget(name)) options[name] = value;
  json defines = json::object();
  for (const auto& [name, value] : reading.defines) defines[name] = value;
  return {{"program version", H2MC_VERSION_STRING},
          {"files", contentsOf(scene.files)},
          {"defines", defines},
          {"permissive", reading.permissive},
          {"width", scene.film.width},
          {"height", scene.film.height},
          {"integrator", integrator.integrator()},
          {"options", options},
          {"seed", seed}};
}

std::string sceneDigest(const json& identity, const std::string& sceneFile) {
  const fs::path folder = fs::path(sceneFile).parent_path();
  json files = json::object();
  for (const auto& [file, sum] : identity.at("files").items()) {
    // Empty where one of the two begins at the root and the other does not.
    const fs::path place = folder.empty() ? fs::path(file).lexically_normal()
                                          : fs::path(file).lexically_relative(folder);
    files[place.empty() ? file : place.string()] = sum;
  }
  const std::string text = json{{"files", files},
                                {"defines", identity.at("defines")},
                                {"permissive", identity.at("permissive")}}
                               .dump(-1, ' ', false, json::error_handler_t::replace);
  return fmt::format("{:08x}",
                     crc32_z(0, reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

}  // namespace h2mc
