// SPDX-License-Identifier: MIT
#include "render/core/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace h2mc {
namespace {

// What is no regular file; "" for one that is.
std::string kindOf(mode_t mode) {
  if (S_ISREG(mode)) return "";
  if (S_ISDIR(mode)) return "it is a folder";
  const char* const kind = S_ISFIFO(mode)   ? "a pipe"
                           : S_ISSOCK(mode) ? "a socket"
                           : S_ISCHR(mode)  ? "a device"
                           : S_ISBLK(mode)  ? "a device"
                                            : "something else";
  return std::string("it is ") + kind + ", expected a regular file";
}

std::string systemError() { return errno == ENOENT ? "no such file" : std::strerror(errno); }

}  // namespace

InputFileError::InputFileError(const std::string& path, const std::string& why)
    : UserError("cannot read \"" + path + "\": " + why), why_(why) {}

InputFile::InputFile(const std::string& path, std::uint64_t largest) : path_(path) {
  const auto check = [&](int result, const struct stat& status) {
    if (result != 0) throw InputFileError(path_, systemError());
    const std::string kind = kindOf(status.st_mode);
    if (!kind.empty()) throw InputFileError(path_, kind);
  };
  struct stat status {};
  // Before it is opened, which may move a tape; and after, since by then it may be something else.
  const int found = stat(path_.c_str(), &status);
  check(found, status);
  descriptor_ = open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor_ < 0) throw InputFileError(path_, systemError());
  try {
    check(fstat(descriptor_, &status), status);
    size_ = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
    if (size_ > largest)
      throw InputFileError(path_, "it has " + sizeText(static_cast<double>(size_)) +
                                      ", expected at most " +
                                      sizeText(static_cast<double>(largest)));
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

InputFile::~InputFile() { close(descriptor_); }

std::string InputFile::bytes(std::uint64_t offset, std::uint64_t count) const {
  std::string text(static_cast<std::size_t>(std::min(count, size_ - std::min(offset, size_))),
                   '\0');
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = pread(descriptor_, text.data() + done, text.size() - done,
                            static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw InputFileError(path_, std::strerror(errno));
    if (n == 0) break;  // it has become shorter
    done += static_cast<std::size_t>(n);
  }
  text.resize(done);
  return text;
}

std::string sizeText(double bytes) {
  const char* const units[] = {"bytes", "kB", "MB", "GB", "TB", "PB", "EB"};
  std::size_t unit = 0;
  while (bytes >= 1000 && unit + 1 < std::size(units)) {
    bytes /= 1000;
    ++unit;
  }
  return fmt::format("{:.4g} {}", bytes, units[unit]);
}

}  // namespace h2mc
