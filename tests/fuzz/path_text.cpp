// SPDX-License-Identifier: MIT
#include "render/path/path_text.h"

#include "fuzz_target.h"
#include "render/core/index.h"
#include "render/core/user_error.h"

namespace h2mc::fuzz {
namespace {

bool inUnitInterval(float v) { return v >= 0 && v < 1; }

}  // namespace

// The option --replay. What is read is a path that exists, and its text reads as the same path.
void readInput(const std::string& input) {
  Technique technique;
  PrimarySample sample;
  const std::string wrong = parsePathText(input, technique, sample);
  if (!wrong.empty()) throw UserError(wrong);
  if (technique.length() < 1 || technique.length() > kMaxPathLength || technique.s < 0 ||
      technique.t < 1)
    throw Finding("a technique that does not exist");
  bool inside = inUnitInterval(sample.time);
  for (int i = 0; i < technique.dimension(); ++i) inside &= inUnitInterval(sample.u[at(i)]);
  for (int i = 0; i < technique.choices(); ++i) inside &= inUnitInterval(sample.choice[at(i)]);
  if (!inside) throw Finding("a coordinate outside [0, 1)");

  Technique again;
  PrimarySample sampleAgain;
  const std::string text = pathText(technique, sample);
  if (!parsePathText(text, again, sampleAgain).empty() || !(again == technique) ||
      pathText(again, sampleAgain) != text)
    throw Finding("it does not read what it has written: " + text);
}

std::string mutateInput(const std::string& input, Random&, const ByteMutator& bytes,
                        std::size_t most) {
  return bytes(input, most);
}

std::span<const std::string_view> words() {
  static constexpr std::string_view kWords[] = {
      "s=",       "t=",       "u=",      "choice=", "time=",         " ",
      ",",        "0x1.8p-1", "0x1p-1",  "0x0p+0",  "0x1.fffffep-1", "0x1p-1074",
      "nan",      "inf",      "0.5,0.5", "1e-50",   "0.99999999",    "s=0 t=2",
      "s=33 t=1", "s=1 t=1",  "\t",      "-0"};
  return kWords;
}

}  // namespace h2mc::fuzz
