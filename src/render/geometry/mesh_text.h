// SPDX-License-Identifier: MIT
// A cursor over the text of a mesh file, line by line.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "render/geometry/mesh_data.h"

namespace h2mc {

// Reads a whole file. Throws MeshError.
std::string readMeshFile(const std::string& path);

// Throws MeshError where there is no memory left for so many bytes; few are not asked about.
void requireMemoryFor(const std::string& mesh, double bytes);

class MeshText {
 public:
  // `continues`: a backslash at a line's end, but for lines with comments, makes one with the next.
  MeshText(std::string name, std::string_view text, bool continues = false)
      : name_(std::move(name)), text_(text), continues_(continues) {}

  // Moves on to the next line; false at the end.
  bool nextLine() {
    while (continued_ && takeLine()) {
    }
    return takeLine();
  }
  // Back to before the first line.
  void rewind() {
    at_ = line_ = 0;
    continued_ = false;
  }

  // The next word of the line; empty at its end.
  std::string_view word() {
    std::string_view result = wordOfLine();
    while (result.empty() && continued_ && takeLine()) result = wordOfLine();
    return result;
  }
  float number() { return toNumber(word()); }

  float toNumber(std::string_view word) const {
    if (word.empty()) fail("a number is missing");
    std::string_view digits = word[0] == '+' ? word.substr(1) : word;
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range && digits.find("e-") != std::string_view::npos)
      return 0;
    const auto narrow = static_cast<float>(value);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(narrow))
      fail("\"" + std::string(word.substr(0, 40)) + "\" is not a finite number");
    return narrow;
  }

  long long toInteger(std::string_view word) const {
    long long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size())
      fail("\"" + std::string(word.substr(0, 40)) + "\" is not an integer");
    return value;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw MeshError(name_ + ":" + std::to_string(line_) + ": " + message);
  }

  // Where the line after the current one starts.
  std::size_t offset() const { return std::min(at_, text_.size()); }
  std::size_t line() const { return line_; }

 private:
  std::string_view wordOfLine() {
    std::size_t i = 0;
    while (i < rest_.size() && isSpace(rest_[i])) ++i;
    std::size_t end = i;
    while (end < rest_.size() && !isSpace(rest_[end])) ++end;
    const std::string_view result = rest_.substr(i, end - i);
    rest_.remove_prefix(end);
    return result;
  }
  bool takeLine() {
    continued_ = false;
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    rest_ = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    if (continues_) {
      std::string_view line = rest_;
      while (!line.empty() && isSpace(line.back())) line.remove_suffix(1);
      continued_ = line.ends_with('\\') && line.find('#') == std::string_view::npos;
      if (continued_) rest_ = line.substr(0, line.size() - 1);
    }
    return true;
  }
  static bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v'; }

  std::string name_;
  std::string_view text_, rest_;
  std::size_t at_ = 0, line_ = 0;
  bool continues_, continued_ = false;  // continued_: this line is, by the next
};

}  // namespace h2mc
