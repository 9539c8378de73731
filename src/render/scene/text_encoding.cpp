// SPDX-License-Identifier: MIT
#include "render/scene/text_encoding.h"

#include <cstddef>
#include <cstdint>

#include "render/scene/suggestion.h"

namespace h2mc {
namespace {

void append(std::string& text, std::uint32_t code) {
  const auto put = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | code >> 6);
    put(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    put(0xE0 | code >> 12);
    put(0x80 | (code >> 6 & 0x3F));
    put(0x80 | (code & 0x3F));
  } else {
    put(0xF0 | code >> 18);
    put(0x80 | (code >> 12 & 0x3F));
    put(0x80 | (code >> 6 & 0x3F));
    put(0x80 | (code & 0x3F));
  }
}

std::uint32_t byteAt(const std::string& bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

std::string fromUtf16(const std::string& bytes, bool bigEndian) {
  constexpr std::uint32_t kReplacement = 0xFFFD, kMark = 0xFEFF;
  const auto unit = [&](std::size_t i) {
    const std::uint32_t a = byteAt(bytes, i), b = byteAt(bytes, i + 1);
    return bigEndian ? a << 8 | b : b << 8 | a;
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xD800 && code < 0xDC00 && i + 3 < bytes.size()) {
      const std::uint32_t low = unit(i + 2);
      if (low >= 0xDC00 && low < 0xE000) {
        code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
        i += 2;
      }
    }
    if (code >= 0xD800 && code < 0xE000) code = kReplacement;  // half a pair
    if (i > 0 || code != kMark) append(text, code);
  }
  return text;
}

std::string fromLatin1(const std::string& bytes) {
  std::string text;
  text.reserve(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) append(text, byteAt(bytes, i));
  return text;
}

bool isUtf8(const std::string& bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const std::uint32_t lead = byteAt(bytes, i);
    const std::size_t length = lead < 0x80                     ? 1
                               : (lead >= 0xC2 && lead < 0xE0) ? 2
                               : (lead & 0xF0) == 0xE0         ? 3
                               : (lead >= 0xF0 && lead < 0xF5) ? 4
                                                               : 0;
    if (length == 0 || i + length > bytes.size()) return false;
    for (std::size_t j = 1; j < length; ++j)
      if ((byteAt(bytes, i + j) & 0xC0) != 0x80) return false;
    i += length;
  }
  return true;
}

// What the XML declaration says, in lower case; "" where it says nothing.
std::string declaredEncoding(const std::string& bytes) {
  if (bytes.rfind("<?xml", 0) != 0) return "";
  const std::string declaration = lowerCase(bytes.substr(0, bytes.find("?>")));
  const std::size_t name = declaration.find("encoding");
  if (name == std::string::npos) return "";
  const std::size_t open = declaration.find_first_of("\"'", name);
  if (open == std::string::npos) return "";
  const std::size_t close = declaration.find(declaration[open], open + 1);
  return close == std::string::npos ? "" : declaration.substr(open + 1, close - open - 1);
}

}  // namespace

std::string toUtf8(std::string bytes) {
  if (bytes.rfind("\xEF\xBB\xBF", 0) == 0) bytes.erase(0, 3);
  if (bytes.size() >= 2) {
    const std::uint32_t a = byteAt(bytes, 0), b = byteAt(bytes, 1);
    if ((a == 0xFF && b == 0xFE) || (a == '<' && b == 0)) return fromUtf16(bytes, false);
    if ((a == 0xFE && b == 0xFF) || (a == 0 && b == '<')) return fromUtf16(bytes, true);
  }
  const std::string encoding = declaredEncoding(bytes);
  const bool latin = encoding.rfind("iso-8859-1", 0) == 0 || encoding.rfind("latin", 0) == 0 ||
                     encoding == "windows-1252" || encoding == "cp1252";
  return latin || !isUtf8(bytes) ? fromLatin1(bytes) : bytes;
}

}  // namespace h2mc
