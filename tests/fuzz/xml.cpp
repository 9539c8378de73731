// SPDX-License-Identifier: MIT
// Scene files: read, and rendered where that succeeds.
#include <spdlog/spdlog.h>

#include <filesystem>

#include "fuzz_target.h"
#include "input_folder.h"
#include "mcmc/render/integrators.h"
#include "render/scene/scene_reader.h"
#include "render_check.h"
#include "scene_mutator.h"
#include "scene_words.h"

namespace h2mc::fuzz {
namespace {

// The folder with all files beside the scene that it may name.
const InputFolder& sceneFolder() {
  static const InputFolder& folder = [&]() -> const InputFolder& {
    namespace fs = std::filesystem;
    for (const auto& entry : fs::directory_iterator(H2MC_SOURCE_DIR "/tests/fuzz/files"))
      fs::copy_file(entry.path(), inputFolder().path() / entry.path().filename(),
                    fs::copy_options::overwrite_existing);
    return inputFolder();
  }();
  return folder;
}

}  // namespace

void readInput(const std::string& input) {
  static const std::vector<IntegratorPlugin> integrators = integratorPlugins();
  spdlog::set_level(spdlog::level::off);  // a dark scene is none of our business
  const std::string file = sceneFolder().write("input.xml", input);
  ReadOptions options;
  options.integrators = integrators;
  options.width = 16;
  options.height = 12;
  options.confine = sceneFolder().path().string();
  // The permissive way goes further, the other one is what most people have.
  options.strictness = input.size() % 2 ? Strictness::kPermissive : Strictness::kByVersion;
  checkRender(readScene(file, options));
}

std::string mutateInput(const std::string& input, Random& random, const ByteMutator& bytes,
                        std::size_t most) {
  return mutateScene(input, random, bytes, most);
}

std::span<const std::string_view> words() {
  static constexpr std::string_view kWords[] = {
      "<",        "/>",         "</",    "<!--",         "-->",      "<![CDATA[", "]]>",
      "<?xml",    "<!DOCTYPE ", "&amp;", "&#0;",         "&#x41;",   "\"",        "name=\"",
      "value=\"", "id=\"",      "$a",    "\xef\xbb\xbf", "\xff\xfe", "\xc0\x80"};
  return kWords;
}

}  // namespace h2mc::fuzz
