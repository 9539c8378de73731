// SPDX-License-Identifier: MIT
#include "render/core/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "render/core/input_file.h"

namespace h2mc {
namespace {

double mostMemory = 0;

// A file of the kernel's that holds one number; infinite where there is none ("max").
double numberIn(const std::string& file) {
  std::ifstream stream(file);
  double number = INFINITY;
  return stream >> number ? number : INFINITY;
}

// The number after a name that stands at the beginning of a line; `otherwise` where it is not there.
double numberAfter(const std::string& file, const std::string& name, double otherwise) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string first;
    double number = 0;
    if (words >> first && first == name) return words >> number ? number : otherwise;
  }
  return otherwise;
}

// What the group of this folder leaves: its limit less what it has. Pages of files that the kernel can drop at once
// count as free.
double leftInGroup(const std::string& folder, const char* limit, const char* usage,
                   const char* inactive) {
  const double most = numberIn(folder + "/" + limit);
  if (!std::isfinite(most)) return INFINITY;
  const double used = numberIn(folder + "/" + usage);
  if (!std::isfinite(used)) return INFINITY;
  return std::max(most - used + numberAfter(folder + "/memory.stat", inactive, 0), 0.0);
}

// Pages of /proc/self/statm in bytes: 0 is what is mapped, 1 what is resident.
double ofProcess(int column) {
  std::ifstream stream("/proc/self/statm");
  double pages = 0;
  for (int i = 0; i <= column; ++i) stream >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace

MemoryLeft memoryLeft() {
  if (mostMemory > 0) return {std::max(mostMemory - ofProcess(1), 0.0), "--max-memory"};
  MemoryLeft left{numberAfter("/proc/meminfo", "MemAvailable:", INFINITY) * 1024, "this machine"};
  const auto least = [&](double bytes, const char* source) {
    if (bytes < left.bytes) left = {bytes, source};
  };
  least(memoryLeftInGroups(), "the control group");
  rlimit space{};
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY)
    least(std::max(static_cast<double>(space.rlim_cur) - ofProcess(0), 0.0), "ulimit -v");
  return left;
}

double memoryLeftInGroups(const std::string& root) {
  double least = INFINITY;
  std::ifstream stream(root + "/proc/self/cgroup");
  for (std::string line; std::getline(stream, line);) {  // number:controllers:/path
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool unified = controllers.empty();
    if (!unified && ("," + controllers + ",").find(",memory,") == std::string::npos) continue;
    const std::string top = root + (unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory");
    std::string path = line.substr(second + 1);
    // Within a container the path may be the host's; the container's own group is then the root.
    for (bool more = true; more;) {
      while (!path.empty() && path.back() == '/') path.pop_back();
      least = std::min(
          least, unified ? leftInGroup(top + path, "memory.max", "memory.current", "inactive_file")
                         : leftInGroup(top + path, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                       "total_inactive_file"));
      more = !path.empty();
      path.erase(more ? path.rfind('/') : 0);
    }
  }
  return least;
}

void setMostMemory(double bytes) { mostMemory = bytes; }

void requireMemory(double bytes, const std::string& what, const std::string& remedy) {
  const MemoryLeft left = memoryLeft();
  if (bytes <= left.bytes) return;
  throw MemoryError(fmt::format("{} needs {} of memory, {} leaves {}; {}{}", what, sizeText(bytes),
                                left.source, sizeText(left.bytes), remedy,
                                mostMemory > 0 ? " or a larger --max-memory"
                                               : ", or --max-memory GB to try it all the same"));
}

}  // namespace h2mc
