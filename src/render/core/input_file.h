// SPDX-License-Identifier: MIT
// Every file that is read is opened here, so that what is no file, or too large, is refused by all readers alike.
#pragma once

#include <cstdint>
#include <string>

#include "render/core/user_error.h"

namespace h2mc {

// Bytes that a file may have. Text: the XML of a scene with all that it includes, a spectrum, records. Data: a mesh, an
// image.
inline constexpr std::uint64_t kLargestText = 64'000'000;
inline constexpr std::uint64_t kLargestData = 16'000'000'000;

// A file that can't be read; what() is the whole message.
class InputFileError : public UserError {
 public:
  InputFileError(const std::string& path, const std::string& why);
  // Why, for a message that names the file itself.
  const std::string& why() const { return why_; }

 private:
  std::string why_;
};

// A regular file, open for reading. Folders, pipes, devices and sockets are refused without waiting for them.
class InputFile {
 public:
  // Throws InputFileError where there is no such file, where it can't be read, where it is none, or where it has more
  // than `largest` bytes.
  InputFile(const std::string& path, std::uint64_t largest);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::uint64_t size() const { return size_; }  // in bytes
  // `count` bytes from `offset` on; fewer where the file ends before. Throws InputFileError.
  std::string bytes(std::uint64_t offset, std::uint64_t count) const;
  // All of it. Throws InputFileError.
  std::string whole() const { return bytes(0, size_); }

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

// A number of bytes as one reads it: "12.5 MB".
std::string sizeText(double bytes);

}  // namespace h2mc
