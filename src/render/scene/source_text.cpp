// SPDX-License-Identifier: MIT
#include "render/scene/source_text.h"

#include <algorithm>

#include "render/core/input_file.h"

namespace h2mc {
namespace {

bool startsCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }  // UTF-8

struct Position {
  std::size_t line = 1, column = 1;  // columns count characters, not bytes
  std::size_t lineStart = 0, lineEnd = 0;
};

Position locate(const std::string& text, std::size_t offset) {
  offset = std::min(offset, text.size());
  Position p;
  p.line = 1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + offset, '\n'));
  const std::size_t before = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
  p.lineStart = before == std::string::npos ? 0 : before + 1;
  p.lineEnd = std::min(text.find('\n', offset), text.size());
  p.column = 1 + static_cast<std::size_t>(std::count_if(text.begin() + p.lineStart,
                                                        text.begin() + offset, startsCharacter));
  return p;
}

// The line and the caret line, cut to a window around the place where the line is long. Tabs and
// control characters become spaces so that the caret stands where it should.
std::string excerpt(const std::string& text, std::size_t offset, const Position& position) {
  constexpr std::size_t kWindow = 110;
  offset = std::min(offset, text.size());
  std::size_t begin = position.lineStart, end = position.lineEnd;
  if (end - begin > kWindow) {
    if (offset - begin > kWindow / 2) begin = offset - kWindow / 2;
    end = std::min(end, begin + kWindow);
    while (begin < offset && !startsCharacter(text[begin])) ++begin;
    while (end < position.lineEnd && !startsCharacter(text[end])) ++end;
  }
  std::string line = begin > position.lineStart ? "... " : "";
  std::string caret(line.size(), ' ');
  for (std::size_t i = begin; i < end; ++i) {
    const bool control = static_cast<unsigned char>(text[i]) < 0x20 || text[i] == 0x7f;
    line += control ? ' ' : text[i];
    if (i < offset && startsCharacter(text[i])) caret += ' ';
  }
  while (!line.empty() && line.back() == ' ' && line.size() > caret.size()) line.pop_back();
  if (end < position.lineEnd) line += " ...";
  return "  " + line + "\n  " + caret + "^";
}

}  // namespace

std::string describe(const SourcePlace& place) {
  if (!place.file) return "scene";
  const Position p = locate(place.file->text, place.offset);
  return place.file->name + ":" + std::to_string(p.line) + ":" + std::to_string(p.column);
}

std::string sourceMessage(const SourcePlace& place, const std::string& kind,
                          const std::string& message, const std::string& hint) {
  std::string result = describe(place) + ": " + kind + ": " + message;
  if (place.file && !place.file->text.empty()) {
    const Position p = locate(place.file->text, place.offset);
    result += "\n" + excerpt(place.file->text, place.offset, p);
  }
  if (!hint.empty()) result += "\n" + hint;
  return result;
}

SceneError sourceError(const SourcePlace& place, const std::string& message,
                       const std::string& hint) {
  return SceneError(sourceMessage(place, "error", message, hint), describe(place));
}

std::string readTextFile(const std::string& path) {
  try {
    return InputFile(path, kLargestText).whole();
  } catch (const InputFileError& e) {
    throw std::runtime_error(e.why());
  }
}

}  // namespace h2mc
