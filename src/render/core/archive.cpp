// SPDX-License-Identifier: MIT
#include "render/core/archive.h"

#include <zlib.h>

#include <istream>
#include <ostream>

namespace h2mc {

void Archive::bytes(void* data, std::size_t size) {
  if (size == 0) return;
  auto* const chars = static_cast<char*>(data);
  if (to_) {
    to_->write(chars, static_cast<std::streamsize>(size));
    if (!*to_) throw ArchiveError("writing failed, is the disk full?");
  } else {
    if (size > left_) throw ArchiveError("it ends too early");
    from_->read(chars, static_cast<std::streamsize>(size));
    if (!*from_) throw ArchiveError("reading failed");
    left_ -= size;
  }
  checksum_ = static_cast<std::uint32_t>(
      crc32_z(checksum_, reinterpret_cast<const unsigned char*>(chars), size));
}

std::size_t Archive::count(std::size_t have, std::size_t least) {
  std::uint64_t size = have;
  one(size);
  if (reading() && size > left_ / least) throw ArchiveError("it ends too early");
  return static_cast<std::size_t>(size);
}

}  // namespace h2mc
