// SPDX-License-Identifier: MIT
#include "cli/checkpoint.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <vector>

#include "cli/commands.h"
#include "cli/identity.h"
#include "render/core/input_file.h"
#include "render/image/atomic_file.h"

namespace h2mc {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// The file: this, the identity as JSON, the render's state, all as Archive writes it, and the CRC-32 of all before.
constexpr std::string_view kMagic = "h2mc checkpoint 1\n";

// In the identity, where it is so.
constexpr const char* kKeepsVariance = "keeps variance";

std::string plain(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// What the two say otherwise, for a person.
std::vector<std::string> differences(const json& there, const json& here) {
  std::vector<std::string> found;
  const auto compare = [&](const json& a, const json& b, const std::string& what) {
    for (const auto& [name, value] : b.items()) {
      const json other = a.value(name, json());
      if (other == value || value.is_object()) continue;
      found.push_back(fmt::format(
          "{}{} is {} there and {} here", what, name,
          other.is_primitive() && !other.is_null() ? plain(other) : "missing", plain(value)));
    }
  };
  const auto part = [](const json& whole, const char* name) {
    json found = whole.value(name, json());
    return found.is_object() ? found : json::object();
  };
  compare(there, here, "");
  compare(part(there, "options"), part(here, "options"), "option ");
  const json defines = part(here, "defines");
  compare(part(there, "defines"), defines, "-D ");
  const json otherDefines = part(there, "defines");
  for (const auto& [name, value] : otherDefines.items())
    if (!defines.contains(name))
      found.push_back(fmt::format("-D {} is {} there and missing here", name, plain(value)));
  const json old = part(there, "files"), now = part(here, "files");
  for (const auto& [file, sum] : now.items())
    if (!old.contains(file))
      found.push_back("\"" + file + "\" is not among its files");
    else if (old[file] != sum)
      found.push_back("\"" + file + "\" has changed");
  for (const auto& [file, sum] : old.items())
    if (!now.contains(file)) found.push_back("it has read \"" + file + "\" too");
  return found;
}

}  // namespace

bool Checkpoint::exists() const {
  std::error_code error;
  return fs::exists(file_, error);
}

Archive& Checkpoint::open() {
  const auto fail = [&](const std::string& why) -> InputError {
    return InputError("the checkpoint \"" + file_ + "\" " + why);
  };
  std::error_code error;
  // What is no file is not waited for.
  try {
    const InputFile file(file_, std::numeric_limits<std::uint64_t>::max());
  } catch (const InputFileError& e) {
    throw fail("cannot be read: " + e.why());
  }
  stream_.open(file_, std::ios::binary);
  const std::uint64_t size = fs::file_size(file_, error);
  std::string magic(sizeof(std::uint64_t) + kMagic.size(), '\0');
  if (error || !stream_) throw fail("cannot be read");
  if (!stream_.read(magic.data(), static_cast<std::streamsize>(magic.size())) ||
      !magic.ends_with(kMagic))
    throw fail("is not one of this program's");
  std::uint32_t sum = 0;
  const std::uint64_t content = size - sizeof sum;
  stream_.seekg(0);
  const std::uint32_t found = checksumOf(stream_, content);
  stream_.read(reinterpret_cast<char*>(&sum), sizeof sum);
  if (!stream_ || sum != found) throw fail("is damaged");
  stream_.seekg(0);
  archive_ = std::make_unique<Archive>(stream_, content);
  std::string text;
  try {
    (*archive_)(magic, text);
  } catch (const ArchiveError&) {
    throw fail("is damaged");
  }
  const json there = json::parse(text, nullptr, false);
  if (!there.is_object()) throw fail("is damaged");
  const std::vector<std::string> different = differences(there, identity_);
  keepsVariance_ = there.value(kKeepsVariance, false);
  if (different.empty()) return *archive_;
  std::string all;
  for (const std::string& one : different) all += (all.empty() ? "" : "; ") + one;
  throw fail("is of another render: " + all);
}

void Checkpoint::save(RenderInProgress& render) const {
  AtomicFile file(file_);
  try {
    std::ofstream stream(file.temporaryPath(), std::ios::binary);
    Archive archive(stream);
    json identity = identity_;
    if (keepsVariance_) identity[kKeepsVariance] = true;
    std::string magic(kMagic), text = identity.dump();
    archive(magic, text);
    render.save(archive);
    std::uint32_t sum = archive.checksum();
    archive(sum);
    stream.close();
    if (!stream) throw ArchiveError("writing failed, is the disk full?");
  } catch (const ArchiveError& e) {
    throw std::runtime_error("cannot write \"" + file_ + "\": " + e.what());
  }
  file.commit();
}

}  // namespace h2mc
