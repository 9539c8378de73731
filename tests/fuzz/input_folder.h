// SPDX-License-Identifier: MIT
// Readers take files: a folder of this process to put an input into.
#pragma once

#include <filesystem>
#include <string>

namespace h2mc::fuzz {

class InputFolder {
 public:
  InputFolder();
  ~InputFolder();
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Writes the file anew; its path.
  std::string write(const std::string& name, const std::string& content) const;

 private:
  std::filesystem::path path_;
};

// The same one at each call.
const InputFolder& inputFolder();

}  // namespace h2mc::fuzz
