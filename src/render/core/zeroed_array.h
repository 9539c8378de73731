// SPDX-License-Identifier: MIT
// Large arrays of zeros that cost nothing until they are written to.
#pragma once

#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

#include "render/core/index.h"

namespace h2mc {

// A fixed number of elements that begin as all bits zero. The system hands out such pages when they are first written
// to: where few pixels of a large picture are touched, the others take neither time nor memory.
template <class T>
class ZeroedArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  ZeroedArray() = default;
  // Throws std::bad_alloc.
  explicit ZeroedArray(std::size_t count)
      : elements_(count > 0 ? static_cast<T*>(std::calloc(count, sizeof(T))) : nullptr),
        size_(count) {
    if (count > 0 && !elements_) throw std::bad_alloc();
  }

  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) { return elements_.get()[i]; }
  const T& operator[](std::size_t i) const { return elements_.get()[i]; }
  T* begin() { return elements_.get(); }
  T* end() { return elements_.get() + size_; }

 private:
  struct Free {
    void operator()(T* elements) const { std::free(elements); }
  };
  std::unique_ptr<T, Free> elements_;
  std::size_t size_ = 0;
};

}  // namespace h2mc
