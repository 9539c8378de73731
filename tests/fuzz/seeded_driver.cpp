// SPDX-License-Identifier: MIT
// PROGRAM CORPUS [MUTATIONS [SEED]]: a target without libFuzzer, so that any build can run it, and twice the same.
// Reads every file of the folder (or the one file), then so many inputs that are made from them. On a finding the input
// is kept as finding-PROGRAM in the current folder.
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "fuzz_target.h"
#include "run_input.h"

#if defined(__SANITIZE_ADDRESS__)
#define H2MC_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define H2MC_ADDRESS_SANITIZER 1
#endif
#endif
#ifdef H2MC_ADDRESS_SANITIZER
#include <sanitizer/common_interface_defs.h>
#endif

namespace h2mc::fuzz {
namespace {

constexpr int kMostSeconds = 10;          // of processor time, for one input
constexpr long kMostKilobytes = 2 << 20;  // of memory
constexpr std::size_t kLongest = 1 << 16;
constexpr std::size_t kMostKept = 1000;

std::string currentInput, findingName;

// What is done here is done in a process that is about to end: of the functions that a signal handler may call.
void keepInput() {
  static bool done = false;
  if (done) return;
  done = true;
  std::FILE* const file = std::fopen(findingName.c_str(), "wb");
  if (!file) return;
  std::fwrite(currentInput.data(), 1, currentInput.size(), file);
  std::fclose(file);
  std::fprintf(stderr, "The input is kept as %s\n", findingName.c_str());
}

extern "C" void onSignal(int signal) {
  if (signal == SIGPROF)
    std::fprintf(stderr, "FINDING: an input has taken more than %d s\n", kMostSeconds);
  keepInput();
  std::signal(signal, SIG_DFL);
  std::raise(signal == SIGPROF ? SIGABRT : signal);
}

void watch() {
  for (const int signal : {SIGABRT, SIGPROF}) std::signal(signal, onSignal);
#ifdef H2MC_ADDRESS_SANITIZER
  __sanitizer_set_death_callback(keepInput);
#else
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, onSignal);
#endif
}

void limitTime(int seconds) {
  const itimerval time{{0, 0}, {seconds, 0}};
  setitimer(ITIMER_PROF, &time, nullptr);
}

void checkMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  if (usage.ru_maxrss <= kMostKilobytes) return;
  std::fprintf(stderr, "FINDING: %ld kB of memory\n", usage.ru_maxrss);
  std::abort();
}

// What is left of a message without what differs from input to input: names and numbers.
std::string kindOf(const std::string& message) {
  std::string kind;
  bool quoted = false;
  for (const char c : message.substr(0, message.find('\n'))) {
    if (c == '"') quoted = !quoted;
    if (!quoted && !(c >= '0' && c <= '9')) kind += c;
  }
  return kind;
}

std::string run(const std::string& input) {
  currentInput = input;
  limitTime(kMostSeconds);
  std::string message = runInput(input);
  limitTime(0);
  checkMemory();
  return message;
}

int fuzz(const std::filesystem::path& corpus, long mutations, std::uint64_t seed) {
  std::vector<std::filesystem::path> files;
  if (std::filesystem::is_directory(corpus))
    for (const auto& entry : std::filesystem::directory_iterator(corpus))
      files.push_back(entry.path());
  else
    files.push_back(corpus);
  std::sort(files.begin(), files.end());
  std::vector<std::string> inputs;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
    if (!stream) {
      std::fprintf(stderr, "%s cannot be read\n", file.c_str());
      return 2;
    }
  }
  if (inputs.empty()) {
    std::fprintf(stderr, "no inputs in %s\n", corpus.c_str());
    return 2;
  }

  // Without knowledge of the branches: an input with a new message has come to a new place. What is made of inputs that
  // were read goes further than what is made of others.
  std::set<std::string> kinds;
  std::vector<std::string> read, refused;
  long accepted = 0;
  for (const std::string& input : inputs) {
    const std::string message = run(input);
    accepted += message.empty();
    (message.empty() ? read : refused).push_back(input);
    kinds.insert(kindOf(message));
  }
  if (read.empty()) {
    std::fprintf(stderr, "none of the files in %s can be read\n", corpus.c_str());
    return 1;
  }
  Random random(seed);
  const ByteMutator bytes = [&](std::string text, std::size_t most) {
    return mutateBytes(std::move(text), words(), random, most);
  };
  for (long i = 0; i < mutations; ++i) {
    const auto& from = refused.empty() || random.chance(0.8) ? read : refused;
    const std::string input = mutateInput(random.pick(from), random, bytes, kLongest);
    const std::string message = run(input);
    accepted += message.empty();
    const bool isNew = kinds.insert(kindOf(message)).second;
    auto& kept = message.empty() ? read : refused;
    if (kept.size() < kMostKept && (isNew || (message.empty() && random.chance(0.1))))
      kept.push_back(input);
  }
  std::printf(
      "%zu files and %ld mutations: %ld read, the others refused with %zu different messages\n",
      files.size(), mutations, accepted, kinds.size() - (accepted > 0));
  return 0;
}

}  // namespace
}  // namespace h2mc::fuzz

int main(int argc, char** argv) {
  using namespace h2mc::fuzz;
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s CORPUS [MUTATIONS [SEED]]\n", argv[0]);
    return 2;
  }
  findingName =
      std::filesystem::absolute("finding-" + std::filesystem::path(argv[0]).filename().string())
          .string();
  watch();
  return fuzz(argv[1], argc > 2 ? std::atol(argv[2]) : 0,
              argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1);
}
