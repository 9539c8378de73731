// SPDX-License-Identifier: MIT
#include "input_folder.h"

#include <unistd.h>

#include <fstream>
#include <stdexcept>

namespace h2mc::fuzz {

namespace fs = std::filesystem;

InputFolder::InputFolder()
    : path_(fs::temp_directory_path() / ("h2mc-fuzz-" + std::to_string(getpid()))) {
  fs::create_directories(path_);
}

InputFolder::~InputFolder() {
  std::error_code code;
  fs::remove_all(path_, code);
}

std::string InputFolder::write(const std::string& name, const std::string& content) const {
  const fs::path file = path_ / name;
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file.string());
  return file.string();
}

const InputFolder& inputFolder() {
  static const InputFolder folder;
  return folder;
}

}  // namespace h2mc::fuzz
