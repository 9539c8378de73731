// SPDX-License-Identifier: MIT
// Do kernels keep a distribution? States before and after, one pair from each chain, are counted in cells: the expected
// change of every cell's count is zero.
#pragma once

#include <cmath>
#include <map>
#include <vector>

#include "chi_square.h"

namespace h2mc::test {

// Counts of weighted, independent pairs of cells. Whatever the weights and the starts' distribution, as long as weight
// times density is what the kernel keeps, the vector d of (count after - count before) has mean 0. Its covariance is
// known from the pairs that change cell, so d^T V^+ d is a chi-square variable. (What stays adds no noise, which is
// what makes pairs so much sharper than a histogram of the states after.)
class PairedTable {
 public:
  void add(int before, int after, double weight) {
    if (before == after) return;
    Flow& flow = flows_[{before, after}];
    flow.weight += weight;
    flow.squares += weight * weight;
    flow.pairs += 1;
  }

  // `tests`: how many verdicts this is one of. Cells that fewer than kFew pairs enter or leave are one cell together.
  ChiSquareVerdict test(int tests) const {
    std::map<int, double> crossings;
    for (const auto& [cells, flow] : flows_)
      for (const int cell : {cells.first, cells.second}) crossings[cell] += flow.pairs;
    std::map<int, int> index;
    int count = 1;  // 0: the rare ones
    for (const auto& [cell, pairs] : crossings) index[cell] = pairs < kFew ? 0 : count++;
    const auto n = at(count);
    std::vector<double> d(n, 0), v(n * n, 0);
    for (const auto& [cells, flow] : flows_) {
      const auto a = at(index[cells.first]), b = at(index[cells.second]);
      if (a == b) continue;
      d[a] -= flow.weight;
      d[b] += flow.weight;
      v[a * n + a] += flow.squares;
      v[b * n + b] += flow.squares;
      v[a * n + b] -= flow.squares;
      v[b * n + a] -= flow.squares;
    }
    ChiSquareVerdict verdict;
    std::size_t worst = 0;
    double worstZ = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double z = v[i * n + i] > 0 ? std::abs(d[i]) / std::sqrt(v[i * n + i]) : 0;
      if (z > worstZ) worst = i, worstZ = z;
    }
    // Elimination; V is a Laplacian, so a pivot vanishes for each component of connected cells, and d with it.
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, v[i * n + i]);
    for (std::size_t k = 0; k < n; ++k) {
      const double pivot = v[k * n + k];
      if (!(pivot > 1e-9 * largest)) continue;
      verdict.statistic += d[k] * d[k] / pivot;
      ++verdict.degrees;
      for (std::size_t i = k + 1; i < n; ++i) {
        const double factor = v[i * n + k] / pivot;
        if (factor == 0) continue;
        for (std::size_t j = k + 1; j < n; ++j) v[i * n + j] -= factor * v[k * n + j];
        d[i] -= factor * d[k];
      }
    }
    verdict.pValue = verdict.degrees > 0 ? chiSquareTail(verdict.statistic, verdict.degrees) : 1;
    verdict.passed = verdict.pValue >= sidak(kFalseAlarmRate, tests);
    std::ostringstream message;
    message << "chi-square " << verdict.statistic << " at " << verdict.degrees
            << " degrees of freedom, p = " << verdict.pValue
            << "; largest change of a cell: " << worstZ << " standard errors";
    for (const auto& [cell, i] : index)
      if (at(i) == worst && worst > 0) message << " in cell " << cell;
    verdict.message = message.str();
    return verdict;
  }

 private:
  static constexpr double kFew = 25;
  struct Flow {
    double weight = 0, squares = 0, pairs = 0;
  };
  std::map<std::pair<int, int>, Flow> flows_;
};

}  // namespace h2mc::test
