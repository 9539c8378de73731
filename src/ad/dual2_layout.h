// How a gradient and the lower triangle of a Hessian lie in vector registers.
//
// Every operation of Dual2 is written once, against a layout that cuts the triangle into vectors
// ("chunks") and can spread a gradient g over a chunk in two ways: row(g) puts g[i] and column(g)
// puts g[j] in the lane of entry (i, j). An outer product is then row(a) * column(b).
//
//  - PackedLayout: the triangle row by row without gaps; row and column are constant shuffles.
//  - RowLayout:    each row starts a new vector; row is a broadcast, column is the gradient itself.
//
// Lanes that hold no entry repeat what some entry does or stay zero, so they are finite wherever
// the entries are, and no operation moves them into an entry.
#pragma once

#include <type_traits>
#include <utility>

// Operations must be inlined for their operands to stay in registers. Not under the sanitizers: their
// checks make the resulting functions so long that compilers need ten minutes for them.
#if defined(__SANITIZE_ADDRESS__)
#define H2MC_AD_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define H2MC_AD_SANITIZED 1
#endif
#endif
#if defined(H2MC_AD_SANITIZED)
#define H2MC_AD_INLINE inline
#define H2MC_AD_LAMBDA
#else
#define H2MC_AD_INLINE inline __attribute__((always_inline))
#define H2MC_AD_LAMBDA __attribute__((always_inline))
#endif

namespace h2mc::ad::detail {

#if defined(__AVX512F__)
inline constexpr int kRegisterBytes = 64;
#elif defined(__AVX__)
inline constexpr int kRegisterBytes = 32;
#else
inline constexpr int kRegisterBytes = 16;
#endif

template <class T, int W>
struct VectorOf {
  typedef T type __attribute__((vector_size(W * sizeof(T))));
};

constexpr int divideUp(int a, int b) { return (a + b - 1) / b; }

/// Lanes of the vectors that hold `entries` numbers: the smallest vector that holds them all, or a
/// whole register.
template <class T>
constexpr int vectorWidth(int entries) {
  const int whole = kRegisterBytes / int(sizeof(T));
  int width = 16 / int(sizeof(T));
  while (width < entries && width < whole) width *= 2;
  return width;
}

/// The same, or half of a register of 64 bytes where two or three halves hold the entries: the gradient of
/// a triangle that is stored so, and its shuffles, are half as wide.
template <class T>
constexpr int narrowWidth(int entries) {
  const int width = vectorWidth<T>(entries), half = 32 / int(sizeof(T));
  return width > half && divideUp(entries, half) <= 3 ? half : width;
}

/// Calls f(std::integral_constant<int, 0>) ... f(std::integral_constant<int, Count - 1>), unrolled.
template <int Count, class F>
H2MC_AD_INLINE void unroll(F&& f) {
  [&]<int... I>(std::integer_sequence<int, I...>) H2MC_AD_LAMBDA {
    (f(std::integral_constant<int, I>{}), ...);
  }
  (std::make_integer_sequence<int, Count>{});
}

template <class T, int N>
struct PackedLayout {
  static constexpr int kEntries = N * (N + 1) / 2;
  static constexpr int kWidth = narrowWidth<T>(kEntries);
  static constexpr int kGradient = divideUp(N, kWidth);        // vectors of the gradient
  static constexpr int kHessian = divideUp(kEntries, kWidth);  // vectors of the triangle
  using Vec = typename VectorOf<T, kWidth>::type;

  /// Where entry (i, j), j <= i, lies, in lanes from the first.
  static constexpr int position(int i, int j) { return i * (i + 1) / 2 + j; }
  static constexpr int rowAt(int position) {
    int i = 0;
    while (PackedLayout::position(i + 1, 0) <= position) ++i;
    return i;
  }
  static constexpr bool holdsEntry(int position) { return position < kEntries; }

  /// The chunk of the triangle with index C.
  template <int C>
  struct Chunk {
    static constexpr int index = C;
    static H2MC_AD_INLINE Vec row(const Vec* g) { return spread<true>(g, kLanes); }
    static H2MC_AD_INLINE Vec column(const Vec* g) { return spread<false>(g, kLanes); }

   private:
    static constexpr std::make_integer_sequence<int, kWidth> kLanes{};
    // Lanes past the last entry repeat entry (0, 0).
    static constexpr int source(int position, bool wantRow) {
      if (!holdsEntry(position)) return 0;
      const int i = rowAt(position);
      return wantRow ? i : position - PackedLayout::position(i, 0);
    }
    template <bool WantRow, int... L>
    static H2MC_AD_INLINE Vec spread(const Vec* g, std::integer_sequence<int, L...>) {
      return __builtin_shufflevector(g[0], g[kGradient - 1], source(C * kWidth + L, WantRow)...);
    }
  };

  template <class F>
  static H2MC_AD_INLINE void forEachChunk(F&& f) {
    unroll<kHessian>([&](auto c) H2MC_AD_LAMBDA { f(Chunk<c>{}); });
  }
};

template <class T, int N>
struct RowLayout {
  // A row that one register holds stays whole.
  static constexpr int kWidth = N > vectorWidth<T>(N) ? narrowWidth<T>(N) : vectorWidth<T>(N);
  static constexpr int firstChunk(int row) {
    const int q = row / kWidth, r = row % kWidth;
    return kWidth * q * (q + 1) / 2 + r * (q + 1);
  }
  static constexpr int kGradient = divideUp(N, kWidth);
  static constexpr int kHessian = firstChunk(N);
  using Vec = typename VectorOf<T, kWidth>::type;

  static constexpr int position(int i, int j) { return firstChunk(i) * kWidth + j; }
  static constexpr int rowAt(int position) {
    int i = 0;
    while (RowLayout::position(i + 1, 0) <= position) ++i;
    return i;
  }
  static constexpr bool holdsEntry(int position) {
    return position - RowLayout::position(rowAt(position), 0) <= rowAt(position);
  }

  template <int C>
  struct Chunk {
    static constexpr int index = C;
    static constexpr int kRow = rowAt(C * kWidth);
    static H2MC_AD_INLINE T row(const Vec* g) { return g[kRow / kWidth][kRow % kWidth]; }
    static H2MC_AD_INLINE Vec column(const Vec* g) { return g[C - firstChunk(kRow)]; }
  };
  struct LoopChunk {
    int index, rowIndex, columnChunk;
    H2MC_AD_INLINE T row(const Vec* g) const { return g[rowIndex / kWidth][rowIndex % kWidth]; }
    H2MC_AD_INLINE Vec column(const Vec* g) const { return g[columnChunk]; }
  };

  // Long triangles are looped over: unrolled, each operation would be thousands of instructions.
  template <class F>
  static H2MC_AD_INLINE void forEachChunk(F&& f) {
    if constexpr (kHessian <= 8) {
      unroll<kHessian>([&](auto c) H2MC_AD_LAMBDA { f(Chunk<c>{}); });
    } else {
      for (int i = 0, index = 0; i < N; ++i)
        for (int k = 0; k <= i / kWidth; ++k, ++index) f(LoopChunk{index, i, k});
    }
  }
};

/// Packed where one shuffle reads the whole gradient, by rows elsewhere: measured faster for every
/// such N and instruction set.
template <class T, int N>
constexpr bool packs() {
  return N <= 2 * PackedLayout<T, N>::kWidth;
}
template <class T, int N>
struct LayoutOf {
  using type = RowLayout<T, N>;
};
template <class T, int N>
requires(packs<T, N>()) struct LayoutOf<T, N> {
  using type = PackedLayout<T, N>;
};

}  // namespace h2mc::ad::detail
