// SPDX-License-Identifier: MIT
// Gradient and Hessian of a function that is composed of functions of few variables, where a dual of
// all coordinates would be wasteful: a recurrence x_(k+1) = f_k(x_k, u_k) is differentiated step by
// step, each by Dual2 with respect to its own x_k and u_k.
//
// Forward, every variable gets its gradient with respect to all coordinates. Backward, it gets the
// result's derivative with respect to it (its adjoint), and
//     H = sum over steps of S^T (sum over the step's outputs o of adjoint_o Hessian_o) S
// where the rows of S are the gradients of the step's inputs [Griewank and Walther 2008, chapter 5].
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <new>
#include <type_traits>
#include <vector>

#include "ad/dual.h"

namespace h2mc::ad {

/// Builds a function of `coordinates()` coordinates and differentiates it. Keeps its memory from one
/// function to the next, so that after the first few nothing is allocated.
template <class T>
class Composition {
 public:
  /// A scalar that the composition knows: coordinates are 0 .. coordinates() - 1.
  using Variable = int;
  static constexpr Variable none() { return -1; }

  /// Starts anew: a function of `coordinates` >= 1 coordinates, at `values`.
  void begin(const T* values, int coordinates);
  int coordinates() const { return coordinates_; }
  T value(Variable v) const { return values_[at(v)]; }

  Variable constant(T value) { return add(value, {0, 0}); }

  /// Where to put the outputs, at most `most` of them, of a function of M variables; their duals'
  /// coordinates stand for those variables. Valid until the next call of anything but value().
  template <int M>
  Dual2<T, M>* outputs(int most);
  /// Takes the first `count` of them, as functions of `inputs`. They become as many variables from the
  /// returned one on.
  template <int M>
  Variable apply(const Variable (&inputs)[M], int count);

  struct Term {
    Variable variable;
    T weight;
  };
  /// The sum of weight * variable; count >= 1.
  Variable linear(const Term* terms, int count);
  Variable linear(std::initializer_list<Term> terms) {
    return linear(terms.begin(), static_cast<int>(terms.size()));
  }
  /// a + b, either of which may be none().
  Variable sum(Variable a, Variable b) {
    if (a == none()) return b;
    if (b == none()) return a;
    return linear({{a, T(1)}, {b, T(1)}});
  }
  /// log(sum over i of exp(c z_i)) / c without overflow; count >= 1, c > 0.
  Variable logSumExp(const Variable* z, int count, T c);
  /// The same of the two (a + b) and z, plus `more`. `more` may be none(), and so may a or b, which leaves
  /// z alone, and z, which leaves a + b: none() if nothing is left.
  Variable logSumExpOfSum(Variable a, Variable b, Variable z, Variable more, T c);

  /// Says that a step's output is what is left of terms that have cancelled within the step: differentiate() counts
  /// `scale` times the square of v's derivatives among what has been added up. Leaves the derivatives alone.
  void cancelled(Variable v, T scale) {
    if (cancelled_.empty()) cancelled_.resize(at(stride_));
    const Lane* const in = row(v);
    for (int k = 0; k < stride_; ++k) cancelled_[at(k)] += scale * in[k] * in[k];
  }

  /// Writes the gradient (coordinates() numbers) and the Hessian's lower triangle, row by row. Returns how
  /// much larger than the Hessian (or than 1, if it is smaller) the terms are that have been added up to it:
  /// by so much their rounding is magnified. (On the diagonal; between the largest entries of each.)
  T differentiate(Variable result, T* gradient, T* hessian);

 private:
  static constexpr int kLanes = detail::kRegisterBytes / int(sizeof(T));
  using Lane = typename detail::VectorOf<T, kLanes>::type;

  // The coordinates that a variable may depend on.
  struct Span {
    int begin, end;
    void include(const Span& other) {
      if (other.end <= other.begin) return;
      begin = std::min(begin, other.begin);
      end = std::max(end, other.end);
    }
    // An empty one, to include others.
    static Span nothing() { return {1 << 30, 0}; }
  };
  struct Node {
    enum Kind { kStep, kLinear, kLogSumExp, kLogSumExpOfSum } kind;
    Variable first;          // of those that it makes
    int count;               // how many
    int inputs, inputCount;  // in terms_
    T curvature;             // of log-sum-exp: c
    std::size_t duals;       // of kStep: in kept_
    void (Composition::*backward)(const Node&);
  };
  struct alignas(64) Block {
    std::byte bytes[64];
  };

  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  static constexpr std::size_t divideUp(std::size_t a, std::size_t b) { return (a + b - 1) / b; }
  static Lane absolute(const Lane& v) { return v < T(0) ? -v : v; }
  static T largest(const Lane& v) {
    T most = v[0];
    for (int i = 1; i < kLanes; ++i) most = std::max<T>(most, v[i]);
    return most;
  }
  static void takeLarger(Lane& most, const Lane& v) { most = v > most ? v : most; }
  Lane* row(Variable v) { return rows_.data() + at(v) * at(stride_); }
  Span spanOf(Variable v) const { return spans_[at(v)]; }

  Variable add(T value, const Span& span) {
    const Variable v = reserve(1, span);
    std::fill_n(row(v), stride_, Lane{});
    values_[at(v)] = value;
    return v;
  }
  // Variables whose values and rows are yet to be set.
  Variable reserve(int count, const Span& span) {
    const Variable first = count_;
    count_ += count;
    if (at(count_) > values_.size()) {
      values_.resize(2 * at(count_));
      adjoints_.resize(2 * at(count_));
      spans_.resize(2 * at(count_));
    }
    if (rows_.size() < at(count_) * at(stride_)) rows_.resize(2 * at(count_) * at(stride_));
    std::fill_n(spans_.begin() + first, count, span);
    return first;
  }

  // Calls f with the number of vectors in a row: a constant where it is small, so that loops vanish.
  template <class F>
  void withStride(F&& f) {
    if (stride_ == 1)
      f(std::integral_constant<int, 1>{});
    else if (stride_ == 2)
      f(std::integral_constant<int, 2>{});
    else
      f(stride_);
  }

  Variable finishLinear(Node& node);
  void linearBackward(const Node& node);
  // hessian += sum over i of scales[i] rows[i] rows[i]^T, rows in scratch_ one after the other.
  void addProducts(const T* scales, int count, const Span& span);
  template <int M>
  void stepBackward(const Node& node);
  template <int M>
  Dual2<T, M>* dualsAt(std::size_t begin) {
    return std::launder(reinterpret_cast<Dual2<T, M>*>(kept_.data() + begin));
  }

  int coordinates_ = 0, stride_ = 0, count_ = 0;
  std::vector<T> values_, adjoints_;
  std::vector<Span> spans_;
  std::vector<Lane> rows_, hessian_, scratch_;
  std::vector<Lane> added_;      // absolute values of the terms on the Hessian's diagonal
  std::vector<Lane> cancelled_;  // those of them that are known beforehand; empty if there are none
  std::vector<Node> nodes_;
  std::vector<Term> terms_;
  std::vector<Block> kept_;
  std::size_t used_ = 0;
};

template <class T>
void Composition<T>::begin(const T* values, int coordinates) {
  coordinates_ = coordinates;
  stride_ = (coordinates + kLanes - 1) / kLanes;
  count_ = 0;
  used_ = 0;
  nodes_.clear();
  terms_.clear();
  cancelled_.clear();
  for (int i = 0; i < coordinates; ++i) {
    const Variable v = add(values[i], {i, i + 1});
    row(v)[i / kLanes][i % kLanes] = T(1);
  }
}

template <class T>
template <int M>
Dual2<T, M>* Composition<T>::outputs(int most) {
  const std::size_t blocks = divideUp(sizeof(Dual2<T, M>) * at(most), sizeof(Block));
  if (kept_.size() < used_ + blocks) kept_.resize(2 * (used_ + blocks));
  return dualsAt<M>(used_);
}

template <class T>
template <int M>
auto Composition<T>::apply(const Variable (&inputs)[M], int count) -> Variable {
  Node node{Node::kStep, count_, count, static_cast<int>(terms_.size()),
            M,           T(0),   used_, &Composition::template stepBackward<M>};
  const Dual2<T, M>* const duals = dualsAt<M>(used_);
  used_ += divideUp(sizeof(Dual2<T, M>) * at(count), sizeof(Block));
  Span span = Span::nothing();
  for (const Variable input : inputs) {
    terms_.push_back({input, T(1)});
    span.include(spanOf(input));
  }
  reserve(count, span);
  for (int o = 0; o < count; ++o) values_[at(node.first + o)] = duals[o].v;
  withStride([&](auto stride) {
    for (int k = 0; k < stride; ++k) {
      Lane in[M];
      for (int i = 0; i < M; ++i) in[i] = row(inputs[i])[k];
      for (int o = 0; o < count; ++o) {
        Lane out = duals[o].gradient(0) * in[0];
        for (int i = 1; i < M; ++i) out += duals[o].gradient(i) * in[i];
        row(node.first + o)[k] = out;
      }
    }
  });
  nodes_.push_back(node);
  return node.first;
}

template <class T>
auto Composition<T>::linear(const Term* terms, int count) -> Variable {
  Node node{Node::kLinear, count_, 1, static_cast<int>(terms_.size()), count, T(0), 0, nullptr};
  terms_.insert(terms_.end(), terms, terms + count);
  return finishLinear(node);
}

template <class T>
auto Composition<T>::logSumExp(const Variable* z, int count, T c) -> Variable {
  if (count == 1) return z[0];
  Node node{Node::kLogSumExp, count_, 1, static_cast<int>(terms_.size()), count, c, 0, nullptr};
  T largest = value(z[0]), total = 0;
  for (int i = 1; i < count; ++i) largest = std::max(largest, value(z[i]));
  for (int i = 0; i < count; ++i) {
    terms_.push_back({z[i], std::exp(c * (value(z[i]) - largest))});
    total += terms_.back().weight;
  }
  for (int i = 0; i < count; ++i) terms_[at(node.inputs + i)].weight /= total;
  const Variable result = finishLinear(node);
  values_[at(result)] = largest + std::log(total) / c;
  return result;
}

template <class T>
auto Composition<T>::logSumExpOfSum(Variable a, Variable b, Variable z, Variable more, T c)
    -> Variable {
  if (a == none() || b == none()) return z == none() ? none() : sum(z, more);
  if (z == none()) return sum(sum(a, b), more);
  Node node{Node::kLogSumExpOfSum, count_, 1, static_cast<int>(terms_.size()), 3, c, 0, nullptr};
  // The weights from the smaller one over the larger.
  const T both = value(a) + value(b), other = value(z),
          ratio = std::exp(-c * std::abs(both - other));
  const T larger = T(1) / (T(1) + ratio), smaller = ratio * larger;
  const T weight = both > other ? larger : smaller;
  terms_.insert(terms_.end(), {{a, weight}, {b, weight}, {z, both > other ? smaller : larger}});
  if (more != none()) {
    terms_.push_back({more, T(1)});
    node.inputCount = 4;
  }
  const Variable result = finishLinear(node);
  values_[at(result)] = std::max(both, other) + std::log1p(ratio) / c;
  if (more != none()) values_[at(result)] += value(more);
  return result;
}

template <class T>
auto Composition<T>::finishLinear(Node& node) -> Variable {
  const Term* const terms = terms_.data() + node.inputs;
  Span span = Span::nothing();
  T sum = 0;
  for (int i = 0; i < node.inputCount; ++i) {
    sum += terms[i].weight * value(terms[i].variable);
    span.include(spanOf(terms[i].variable));
  }
  const Variable result = reserve(1, span);
  values_[at(result)] = sum;
  withStride([&](auto stride) {
    for (int k = 0; k < stride; ++k) {
      Lane out{};
      // What has no weight need not be finite.
      for (int i = 0; i < node.inputCount; ++i)
        if (terms[i].weight != T(0)) out += terms[i].weight * row(terms[i].variable)[k];
      row(result)[k] = out;
    }
  });
  nodes_.push_back(node);
  return result;
}

template <class T>
T Composition<T>::differentiate(Variable result, T* gradient, T* hessian) {
  std::memcpy(gradient, row(result), sizeof(T) * at(coordinates_));
  hessian_.assign(at(coordinates_ * stride_), Lane{});
  if (cancelled_.empty())
    added_.assign(at(stride_), Lane{});
  else
    added_ = cancelled_;
  std::fill_n(adjoints_.begin(), count_, T(0));
  adjoints_[at(result)] = T(1);
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    const Node& node = nodes_[n];
    if (node.kind == Node::kStep)
      (this->*node.backward)(node);
    else
      linearBackward(node);
  }
  Lane most = Lane{} + T(1), terms{};
  for (int k = 0; k < stride_; ++k) takeLarger(terms, added_[at(k)]);
  // Whole vectors where what they write too much is written again.
  const T* const end = hessian + at(coordinates_) * at(coordinates_ + 1) / 2;
  for (int i = 0; i < coordinates_; hessian += ++i) {
    const Lane* const h = hessian_.data() + i * stride_;
    for (int k = 0; k <= i / kLanes; ++k) takeLarger(most, absolute(h[k]));
    if (stride_ == 1 && end - hessian >= kLanes)
      std::memcpy(hessian, h, sizeof(Lane));
    else
      std::memcpy(hessian, h, sizeof(T) * at(i + 1));
  }
  return largest(terms) / largest(most);
}

// hessian += S^T H S, H = the outputs' Hessians, each times its adjoint, S = the inputs' rows.
template <class T>
template <int M>
void Composition<T>::stepBackward(const Node& node) {
  using Dual = Dual2<T, M>;
  const Dual* const duals = dualsAt<M>(node.duals);
  Dual total(T(0));
  bool any = false;
  for (int o = 0; o < node.count; ++o) {
    const T adjoint = adjoints_[at(node.first + o)];
    if (adjoint == T(0)) continue;
    any = true;
    total += duals[o] * adjoint;
  }
  if (!any) return;
  const Term* const inputs = terms_.data() + node.inputs;
  const Lane* rows[M];
  for (int i = 0; i < M; ++i) {
    adjoints_[at(inputs[i].variable)] += total.gradient(i);
    rows[i] = row(inputs[i].variable);
  }
  const Span span = spanOf(node.first);
  withStride([&](auto stride) {
    for (int k = span.begin / kLanes; k < stride; ++k) {
      Lane weighted[M];
      for (int i = 0; i < M; ++i) {
        weighted[i] = total.hessian(i, 0) * rows[0][k];
        for (int j = 1; j < M; ++j) weighted[i] += total.hessian(i, j) * rows[j][k];
      }
      Lane diagonal = rows[0][k] * weighted[0];
      for (int i = 1; i < M; ++i) diagonal += rows[i][k] * weighted[i];
      added_[at(k)] += absolute(diagonal);
      // The lower triangle is enough: rows from this vector's first coordinate on.
      for (int a = std::max(span.begin, k * kLanes); a < span.end; ++a) {
        Lane& h = hessian_[at(a * stride + k)];
        Lane sum = h;
        for (int i = 0; i < M; ++i) sum += rows[i][a / kLanes][a % kLanes] * weighted[i];
        h = sum;
      }
    }
  });
}

// A weighted sum, and what makes log-sum-exp curved: hessian += scale d d^T for each term, with d its
// row's difference from the result's; of two terms, once with their difference.
template <class T>
void Composition<T>::linearBackward(const Node& node) {
  const T adjoint = adjoints_[at(node.first)];
  if (adjoint == T(0)) return;
  const Term* const terms = terms_.data() + node.inputs;
  for (int i = 0; i < node.inputCount; ++i)
    adjoints_[at(terms[i].variable)] += adjoint * terms[i].weight;
  if (node.kind == Node::kLinear) return;
  const Span span = spanOf(node.first);
  const T curvature = adjoint * node.curvature;
  if (node.kind == Node::kLogSumExpOfSum) {
    const T scale = curvature * terms[0].weight * terms[2].weight;
    if (scale == T(0)) return;
    scratch_.resize(at(stride_));
    const Lane *const a = row(terms[0].variable), *const b = row(terms[1].variable),
                      *const z = row(terms[2].variable);
    withStride([&](auto stride) {
      for (int k = 0; k < stride; ++k) scratch_[at(k)] = a[k] + b[k] - z[k];
    });
    addProducts(&scale, 1, span);
    return;
  }
  constexpr int kAtOnce = 4;
  scratch_.resize(at(kAtOnce * stride_));
  const Lane* const mean = row(node.first);
  T scales[kAtOnce];
  int count = 0;
  for (int i = 0; i < node.inputCount; ++i) {
    const T scale = curvature * terms[i].weight;
    if (scale != T(0)) {
      const Lane* const in = row(terms[i].variable);
      for (int k = 0; k < stride_; ++k) scratch_[at(count * stride_ + k)] = in[k] - mean[k];
      scales[count++] = scale;
    }
    if (count > 0 && (count == kAtOnce || i + 1 == node.inputCount)) {
      addProducts(scales, count, span);
      count = 0;
    }
  }
}

template <class T>
void Composition<T>::addProducts(const T* scales, int count, const Span& span) {
  const Lane* const d = scratch_.data();
  withStride([&](auto stride) {
    for (int i = 0; i < count; ++i)
      for (int k = span.begin / kLanes; k < stride; ++k)
        added_[at(k)] += std::abs(scales[i]) * d[i * stride + k] * d[i * stride + k];
    for (int a = span.begin; a < span.end; ++a) {
      Lane* const h = hessian_.data() + a * stride;
      const int last = stride == 1 ? 0 : a / kLanes;
      for (int k = 0; k <= last; ++k) {
        Lane sum = h[k];
        for (int i = 0; i < count; ++i)
          sum += scales[i] * d[i * stride + last][a % kLanes] * d[i * stride + k];
        h[k] = sum;
      }
    }
  });
}

}  // namespace h2mc::ad
