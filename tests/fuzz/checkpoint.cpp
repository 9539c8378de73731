// SPDX-License-Identifier: MIT
// Checkpoints up to the render's state: what --resume meets before it knows that the file is its own. Each input is
// tried as it is, and with the checksum that its bytes ought to have.
#include "cli/checkpoint.h"

#include <zlib.h>

#include <cstring>

#include "fuzz_target.h"
#include "input_folder.h"

namespace h2mc::fuzz {
namespace {

using Sum = std::uint32_t;

std::string withChecksum(std::string file) {
  if (file.size() < sizeof(Sum)) return file;
  const std::size_t content = file.size() - sizeof(Sum);
  const Sum sum =
      static_cast<Sum>(crc32_z(0, reinterpret_cast<const unsigned char*>(file.data()), content));
  std::memcpy(file.data() + content, &sum, sizeof sum);
  return file;
}

// The identity of the corpus's checkpoint.
nlohmann::json identity() {
  return {{"program version", "0"},
          {"files", {{"scene.xml", "12345678"}}},
          {"width", 16},
          {"height", 12},
          {"integrator", "h2mc"},
          {"options", {{"maxDepth", "4"}}},
          {"seed", 7}};
}

// A state of all kinds that an archive knows.
struct State {
  std::vector<double> numbers;
  std::vector<std::string> texts;
  ZeroedArray<float> film;
  std::optional<long long> maybe;
  std::array<int, 3> three{};

  void archive(Archive& archive) { archive(numbers, texts, film, maybe, three); }
};

void open(const std::string& content) {
  Checkpoint checkpoint(inputFolder().write("input.checkpoint", content), identity());
  Archive& archive = checkpoint.open();
  State state;
  const std::uint64_t before = archive.left();
  try {
    archive(state);
  } catch (const ArchiveError& e) {
    throw UserError(e.what());
  }
  if (archive.left() > before) throw Finding("more is left than there was");
}

}  // namespace

void readInput(const std::string& input) {
  const std::string repaired = withChecksum(input);
  if (repaired != input) try {
      open(input);
      throw Finding("damage that the checksum does not show");
    } catch (const UserError&) {
    }
  open(repaired);
}

std::string mutateInput(const std::string& input, Random&, const ByteMutator& bytes,
                        std::size_t most) {
  return bytes(input, most);
}

std::span<const std::string_view> words() {
  using namespace std::string_view_literals;
  static constexpr std::string_view kWords[] = {"h2mc checkpoint 1\n",
                                                "\"options\":",
                                                "\"files\":",
                                                "\"seed\":",
                                                "{}",
                                                "null",
                                                "[[[[[[[[",
                                                "\"\\ud800\"",
                                                "\x12\0\0\0\0\0\0\0"sv,
                                                "\xff\xff\xff\xff\xff\xff\xff\xff"sv};
  return kWords;
}

}  // namespace h2mc::fuzz
