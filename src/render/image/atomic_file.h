// SPDX-License-Identifier: MIT
// Files that are there whole or not at all.
#pragma once

#include <string>

namespace h2mc {

// A file under a temporary name beside its target. commit() gives it the target's name; without it
// the destructor removes it.
class AtomicFile {
 public:
  // Creates the temporary file, empty. Throws std::runtime_error, what() being the whole message,
  // if `target` is a folder or a device, is write-protected, or its folder lets nothing be created.
  explicit AtomicFile(const std::string& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Where to write; it has the target's ending.
  const std::string& temporaryPath() const { return temporary_; }

  // Replaces the target, once the file is on the disk: after a power cut there is the old one or the new one. The file
  // must be closed. Throws std::runtime_error.
  void commit();

 private:
  std::string target_;  // symbolic links followed
  std::string temporary_;
  int slot_ = -1;
};

// Writes text to `target` through an AtomicFile. Throws std::runtime_error.
void writeTextAtomically(const std::string& target, const std::string& text);

// Removes the temporary files for this target that processes have left that are no more: those that were killed.
void removeAbandoned(const std::string& target);

// Removes the temporary files that exist now. For a signal handler that ends the program at once:
// it calls nothing that is unsafe there.
void removeTemporaryFiles() noexcept;

}  // namespace h2mc
