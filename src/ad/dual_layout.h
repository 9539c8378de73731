// SPDX-License-Identifier: MIT
// How gradients and the lower triangles of Hessians lie in vector registers.
//
// Every operation of duals is written once, against a layout that cuts the triangle into vectors
// ("chunks") and can spread a gradient g over a chunk in two ways: row(g) puts g[i] and column(g)
// puts g[j] in the lane of entry (i, j). An outer product is then row(a) * column(b).
//
// The gradient is cut into blocks, one for each of its vectors, and the triangle into products of blocks:
//
//  - A block with itself: each lane's entries belong to the lane's own coordinate, so that row is the
//    gradient itself and column one constant shuffle. Each pair of coordinates is given to the one or
//    the other as its row, so that no lane is wasted.
//  - A block with an earlier one: row by row; row is a broadcast, column the gradient itself.
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

/// Lanes of the vectors for N coordinates: the smallest that holds the gradient, or 32 bytes where that is
/// too small for the triangle. Measured faster than whole registers and than 16 bytes.
template <class T>
constexpr int layoutWidth(int n) {
  const int gradient = vectorWidth<T>(n), triangle = vectorWidth<T>(n * (n + 1) / 2);
  return gradient * int(sizeof(T)) < 32 && triangle > gradient ? 2 * gradient : gradient;
}

/// Calls f(std::integral_constant<int, 0>) ... f(std::integral_constant<int, Count - 1>), unrolled.
template <int Count, class F>
H2MC_AD_INLINE void unroll(F&& f) {
  [&]<int... I>(std::integer_sequence<int, I...>) H2MC_AD_LAMBDA {
    (f(std::integral_constant<int, I>{}), ...);
  }
  (std::make_integer_sequence<int, Count>{});
}

/// The square of a block of N coordinates in vectors of W >= N lanes, lane L holding entries (L mod N, j).
template <int N, int W>
class Orientation {
  static_assert(0 < N && N <= W);
  static constexpr int kLeast = divideUp(N * (N + 1) / 2, W);
  struct Table {
    int chunks = 0;                  // 0: the entries do not fit
    int position[N][N] = {};         // of entry (i, j), for both orders, in lanes from the first
    int column[kLeast + 1][W] = {};  // of a lane's entry, one of the diagonal where there is none
  };

  // Fills `chunks` vectors; with `diagonalFirst` the first holds entries (i, i) alone, whose column
  // is their row. Pairs in the order of their distance around a circle, each to the coordinate that has
  // more lanes left.
  static constexpr Table fill(int chunks, bool diagonalFirst) {
    Table t;
    for (auto& chunk : t.column)
      for (int lane = 0; lane < W; ++lane) chunk[lane] = lane % N;
    int next[N] = {}, left[N] = {};  // a coordinate's next free lane, and how many it has
    const auto advance = [&](int i) {
      const bool sameVector = next[i] % W + N < W;
      next[i] = sameVector ? next[i] + N : (next[i] / W + 1) * W + i;
      --left[i];
    };
    for (int i = 0; i < N; ++i) {
      t.position[i][i] = next[i] = i;
      left[i] = chunks * divideUp(W - i, N);
      do advance(i);
      while (diagonalFirst && next[i] < W);
    }
    for (int distance = 1; 2 * distance <= N; ++distance)
      for (int i = 0; i < (2 * distance == N ? distance : N); ++i) {
        const int j = (i + distance) % N;
        const int row = left[i] >= left[j] ? i : j;
        if (left[row] <= 0) return {};
        t.column[next[row] / W][next[row] % W] = row == i ? j : i;
        t.position[i][j] = t.position[j][i] = next[row];
        advance(row);
      }
    t.chunks = chunks;
    return t;
  }
  static constexpr Table best() {
    for (const bool diagonalFirst : {true, false})
      if (const Table t = fill(kLeast, diagonalFirst); t.chunks > 0) return t;
    return fill(kLeast + 1, true);
  }
  static constexpr Table kTable = best();
  static_assert(kTable.chunks > 0);

 public:
  static constexpr int kChunks = kTable.chunks;
  static constexpr int position(int i, int j) { return kTable.position[i][j]; }
  static constexpr int column(int chunk, int lane) { return kTable.column[chunk][lane]; }
  /// Whether column(chunk, lane) is lane mod N throughout.
  static constexpr bool isDiagonal(int chunk) {
    for (int lane = 0; lane < W; ++lane)
      if (column(chunk, lane) != lane % N) return false;
    return true;
  }
};

template <class T, int N>
struct TriangleLayout {
  static constexpr int kWidth = layoutWidth<T>(N);
  static constexpr int kGradient = divideUp(N, kWidth);  // vectors of the gradient, one a block
  using Vec = typename VectorOf<T, kWidth>::type;

 private:
  static constexpr int kLast = kGradient - 1;  // the last block, of 1 to kWidth coordinates
  static constexpr int kLastSize = N - kLast * kWidth;
  using Whole = Orientation<kWidth, kWidth>;
  using Last = Orientation<kLastSize, kWidth>;
  template <int Block>
  using OrientationOf = std::conditional_t<(Block < kLast), Whole, Last>;
  template <int I>
  using Int = std::integral_constant<int, I>;
  static constexpr int kMostUnrolled = 20;
  static constexpr int squareSize(int block) {
    return block < kLast ? Whole::kChunks : Last::kChunks;
  }
  // A block's square comes first, then its rows, each with one vector for every earlier block.
  static constexpr int firstOfSquare(int block) {
    return block * Whole::kChunks + kWidth * (block * (block - 1) / 2);
  }
  static constexpr int firstOfRow(int i) {
    const int block = i / kWidth;
    return firstOfSquare(block) + squareSize(block) + i % kWidth * block;
  }

 public:
  static constexpr int kHessian = firstOfRow(N - 1) + kLast;  // vectors of the triangle
  /// The gradient's lanes of the last block's coordinate i are i, i + kRepeat, ... to the vector's end.
  static constexpr int kRepeat = kLastSize;

  /// Where entry (i, j), j <= i, lies, in lanes from the first.
  static constexpr int position(int i, int j) {
    const int block = i / kWidth, r = i % kWidth, c = j % kWidth;
    if (j / kWidth < block) return (firstOfRow(i) + j / kWidth) * kWidth + c;
    return firstOfSquare(block) * kWidth +
           (block < kLast ? Whole::position(r, c) : Last::position(r % kLastSize, c % kLastSize));
  }

  // Chunks' numbers are constants of their own type where chunks are unrolled, int where they are not.
  /// A block with itself.
  template <class Orient, int C, class Index, class Block>
  struct SquareChunk {
    Index index;
    Block block;
    H2MC_AD_INLINE Vec row(const Vec* g) const { return g[block]; }
    H2MC_AD_INLINE Vec column(const Vec* g) const {
      if constexpr (Orient::isDiagonal(C)) return g[block];
      return spread(g[block], std::make_integer_sequence<int, kWidth>{});
    }

   private:
    template <int... L>
    static H2MC_AD_INLINE Vec spread(const Vec& g, std::integer_sequence<int, L...>) {
      return __builtin_shufflevector(g, g, Orient::column(C, L)...);
    }
  };
  /// One row of a block with an earlier one.
  template <class Index, class Row, class Block>
  struct RowChunk {
    Index index;
    Row i;
    Block block;
    H2MC_AD_INLINE T row(const Vec* g) const { return g[i / kWidth][i % kWidth]; }
    H2MC_AD_INLINE Vec column(const Vec* g) const { return g[block]; }
  };

  /// Calls f with every chunk. Long triangles are looped over: unrolled, each operation would be
  /// thousands of instructions.
  template <class F>
  static H2MC_AD_INLINE void forEachChunk(F&& f) {
    if constexpr (kHessian <= kMostUnrolled) {
      unroll<kGradient>([&](auto block) H2MC_AD_LAMBDA {
        constexpr int kBlock = block;
        unroll<squareSize(kBlock)>([&](auto c) H2MC_AD_LAMBDA {
          using Index = Int<firstOfSquare(kBlock) + c>;
          f(SquareChunk<OrientationOf<kBlock>, c, Index, Int<kBlock>>{});
        });
        unroll<(kBlock < kLast ? kWidth : kLastSize)>([&](auto i) H2MC_AD_LAMBDA {
          constexpr int kRow = kBlock * kWidth + i;
          unroll<kBlock>([&](auto k) H2MC_AD_LAMBDA {
            f(RowChunk<Int<firstOfRow(kRow) + k>, Int<kRow>, Int<k>>{});
          });
        });
      });
    } else {
      for (int block = 0; block < kLast; ++block)
        unroll<Whole::kChunks>([&](auto c) H2MC_AD_LAMBDA {
          f(SquareChunk<Whole, c, int, int>{firstOfSquare(block) + c, block});
        });
      unroll<Last::kChunks>([&](auto c) H2MC_AD_LAMBDA {
        f(SquareChunk<Last, c, int, int>{firstOfSquare(kLast) + c, kLast});
      });
      for (int i = kWidth; i < N; ++i)
        for (int k = 0; k < i / kWidth; ++k) f(RowChunk<int, int, int>{firstOfRow(i) + k, i, k});
    }
  }
};

/// A gradient alone: no chunks.
template <class T, int N>
struct GradientLayout {
  static constexpr int kWidth = vectorWidth<T>(N);
  static constexpr int kGradient = divideUp(N, kWidth);
  static constexpr int kHessian = 0;
  static constexpr int kRepeat = N - (kGradient - 1) * kWidth;
  using Vec = typename VectorOf<T, kWidth>::type;
  template <class F>
  static H2MC_AD_INLINE void forEachChunk(F&&) {}
};

/// How vectors of M coordinates become vectors of N, coordinate i becoming i + Offset (Dual::lift). Both
/// gradients are single vectors.
template <class From, class To, int M, int N, int Offset>
class LiftTable {
  static constexpr int kWidth = To::kWidth;
  using Lanes = std::make_integer_sequence<int, kWidth>;

  struct Sources {
    int of[To::kHessian * kWidth];  // in lanes from the first, -1 for a zero
  };
  static constexpr Sources sources() {
    Sources s{};
    for (int& source : s.of) source = -1;
    for (int i = 0; i < M; ++i)
      for (int j = 0; j <= i; ++j)
        s.of[To::position(i + Offset, j + Offset)] = From::position(i, j);
    return s;
  }
  static constexpr Sources kSources = sources();

  // Indices into a vector with a zero behind it.
  static constexpr int triangleIndex(int to, int from, int lane) {
    const int source = kSources.of[to * kWidth + lane];
    return source >= 0 && source / From::kWidth == from ? source % From::kWidth : From::kWidth;
  }
  static constexpr int gradientIndex(int lane) {
    const int i = lane % N - Offset;
    return i >= 0 && i < M ? i : From::kWidth;
  }
  template <class V, int... L>
  static H2MC_AD_INLINE typename To::Vec gradient(const V& g, std::integer_sequence<int, L...>) {
    return __builtin_shufflevector(g, V{}, gradientIndex(L)...);
  }
  template <int I, int K, class V, int... L>
  static H2MC_AD_INLINE typename To::Vec triangle(const V& h, std::integer_sequence<int, L...>) {
    return __builtin_shufflevector(h, V{}, triangleIndex(I, K, L)...);
  }

 public:
  static H2MC_AD_INLINE typename To::Vec gradient(const typename From::Vec& g) {
    return gradient(g, Lanes{});
  }
  /// Whether vector `to` of the triangle takes anything from vector `from`.
  static constexpr bool reads(int to, int from) {
    for (int lane = 0; lane < kWidth; ++lane)
      if (triangleIndex(to, from, lane) < From::kWidth) return true;
    return false;
  }
  /// What vector I takes from vector K.
  template <int I, int K>
  static H2MC_AD_INLINE typename To::Vec triangle(const typename From::Vec& h) {
    return triangle<I, K>(h, Lanes{});
  }
};

}  // namespace h2mc::ad::detail
