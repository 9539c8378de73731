// SPDX-License-Identifier: MIT
#include "render/image/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace h2mc {
namespace {

namespace fs = std::filesystem;

// The names of the temporary files there are, where a signal handler can read them. More files at
// once than slots are written all the same, only not removed by a signal.
std::array<std::atomic<const char*>, 16> temporaryNames{};

[[noreturn]] void fail(const std::string& target, const std::string& why) {
  throw std::runtime_error("cannot write \"" + target + "\": " + why);
}

// Returns when what was written is on the disk.
void sync(const std::string& file, const std::string& target) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = descriptor >= 0 && (fsync(descriptor) == 0 || errno == EINVAL);
  const int why = errno;
  if (descriptor >= 0) close(descriptor);
  if (!done) fail(target, std::strerror(why));
}

// What temporary names begin with, after which come the process and a counter.
std::string temporaryPrefix(const fs::path& path) { return "." + path.stem().string() + ".tmp-"; }

// The file that a chain of symbolic links ends at, there or not.
fs::path followLinks(const std::string& target) {
  fs::path path = target;
  std::error_code error;
  for (int i = 0; i < 40 && fs::is_symlink(path, error); ++i)
    path = path.parent_path() / fs::read_symlink(path, error);
  return path;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& target) {
  if (target.empty()) fail(target, "the file name is empty");
  const fs::path path = followLinks(target);
  target_ = path.string();

  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status) || !path.has_filename()) fail(target, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) fail(target, "it is not a regular file");
  if (fs::exists(status) && access(target_.c_str(), W_OK) != 0) fail(target, std::strerror(errno));
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    fail(target, "there is no folder \"" + folder.string() + "\"");

  // The process and a counter make the name unique; O_EXCL makes sure of it.
  static std::atomic<unsigned> counter{0};
  int descriptor = -1;
  for (int attempt = 0; attempt < 100 && descriptor < 0; ++attempt) {
    temporary_ = (folder / (temporaryPrefix(path) + std::to_string(getpid()) + "-" +
                            std::to_string(counter++) + path.extension().string()))
                     .string();
    descriptor = open(temporary_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno != EEXIST) fail(target, std::strerror(errno));
  }
  if (descriptor < 0) fail(target, "no free temporary name beside it");
  close(descriptor);

  for (std::size_t i = 0; i < temporaryNames.size() && slot_ < 0; ++i) {
    const char* none = nullptr;
    if (temporaryNames[i].compare_exchange_strong(none, temporary_.c_str()))
      slot_ = static_cast<int>(i);
  }
}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) unlink(temporary_.c_str());
  if (slot_ >= 0) temporaryNames[slot_] = nullptr;
}

void AtomicFile::commit() {
  sync(temporary_, target_);
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail(target_, std::strerror(errno));
  if (slot_ >= 0) temporaryNames[slot_] = nullptr;
  slot_ = -1;
  temporary_.clear();
}

void writeTextAtomically(const std::string& target, const std::string& text) {
  AtomicFile file(target);
  std::ofstream stream(file.temporaryPath(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) fail(target, "writing failed, is the disk full?");
  file.commit();
}

void removeAbandoned(const std::string& target) {
  const fs::path path = followLinks(target);
  const std::string prefix = temporaryPrefix(path);
  std::error_code error;
  fs::directory_iterator entries(path.has_parent_path() ? path.parent_path() : fs::path("."),
                                 error);
  std::vector<fs::path> abandoned;
  for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    const std::string name = entries->path().filename().string();
    if (!name.starts_with(prefix) || entries->path().extension() != path.extension()) continue;
    const pid_t process = static_cast<pid_t>(std::atol(name.c_str() + prefix.size()));
    if (process > 0 && kill(process, 0) != 0 && errno == ESRCH)
      abandoned.push_back(entries->path());
  }
  for (const fs::path& file : abandoned) fs::remove(file, error);
}

void removeTemporaryFiles() noexcept {
  for (auto& name : temporaryNames)
    if (const char* path = name.load()) unlink(path);
}

}  // namespace h2mc
