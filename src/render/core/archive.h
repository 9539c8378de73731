// SPDX-License-Identifier: MIT
// State on its way to a file and back. A class says once what it consists of, in a member archive(), which both writes
// and reads it.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "render/core/zeroed_array.h"

namespace h2mc {

// What is read is not what was written, or could not be written. what() says why, without the file's name.
class ArchiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Numbers and plain structs are stored as they lie in memory: for the same program on the same kind of machine.
// A CRC-32 of all bytes is kept on the way.
class Archive {
 public:
  // Keeps a reference.
  explicit Archive(std::ostream& to) : to_(&to) {}
  // Of the stream, so many bytes may be read.
  Archive(std::istream& from, std::uint64_t size) : from_(&from), left_(size) {}

  bool reading() const { return from_ != nullptr; }
  std::uint32_t checksum() const { return checksum_; }
  std::uint64_t left() const { return left_; }

  // Writes or reads all of them, in this order. Throws ArchiveError.
  template <class... T>
  void operator()(T&... values) {
    (one(values), ...);
  }
  void bytes(void* data, std::size_t size);

 private:
  template <class T>
  void one(T& value) {
    if constexpr (requires { value.archive(*this); }) {
      value.archive(*this);
    } else {
      static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
      bytes(&value, sizeof(T));
    }
  }
  template <class T>
  void one(std::vector<T>& values) {
    values.resize(count(values.size(), std::is_trivially_copyable_v<T> ? sizeof(T) : 1));
    elements(values.data(), values.size());
  }
  template <class T>
  void one(ZeroedArray<T>& values) {
    const std::size_t size = count(values.size(), sizeof(T));
    if (size != values.size()) values = ZeroedArray<T>(size);
    elements(values.begin(), size);
  }
  template <class T, std::size_t n>
  void one(std::array<T, n>& values) {
    elements(values.data(), n);
  }
  template <class T>
  void one(std::optional<T>& value) {
    std::uint8_t there = value.has_value();  // a byte that is read may be no bool
    one(there);
    if (reading() && there) value.emplace();
    if (reading() && !there) value.reset();
    if (there) one(*value);
  }
  void one(std::string& text) {
    text.resize(count(text.size(), 1));
    bytes(text.data(), text.size());
  }
  template <class T>
  void elements(T* values, std::size_t size) {
    if constexpr (std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> &&
                  !requires(Archive & a) { values->archive(a); }) {
      bytes(values, size * sizeof(T));
    } else {
      for (std::size_t i = 0; i < size; ++i) one(values[i]);
    }
  }
  // Writes how many there are, or reads how many there will be, each of at least so many bytes.
  std::size_t count(std::size_t have, std::size_t least);

  std::ostream* to_ = nullptr;
  std::istream* from_ = nullptr;
  std::uint64_t left_ = 0;
  std::uint32_t checksum_ = 0;
};

}  // namespace h2mc
