// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/sparse_pattern.hpp"

#include <algorithm>
#include <cassert>

#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// For each node with unknowns, the neighbours of equal or higher number, ascending.
std::vector<std::vector<std::int32_t>> upper_neighbours(
    const std::vector<std::span<const std::int32_t>>& groups, const std::vector<int>& equation) {
  std::vector<std::vector<std::int32_t>> neighbours(equation.size());
  for (const auto group : groups)
    for (const auto a : group) {
      if (equation[to_index(a)] < 0) continue;
      for (const auto b : group)
        if (b >= a && equation[to_index(b)] >= 0) neighbours[to_index(a)].push_back(b);
    }
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbours;
}

}  // namespace

int SparsePattern::position(int i, int j) const {
  const auto [column, target] = std::minmax(i, j);
  const auto first = row.begin() + start[to_index(column)],
             last = row.begin() + start[to_index(column) + 1];
  const auto found = std::lower_bound(first, last, target);
  assert(found != last && *found == target);
  return static_cast<int>(found - row.begin());
}

SparsePattern stiffness_pattern(const std::vector<std::span<const std::int32_t>>& groups,
                                const std::vector<int>& equation, int unknowns) {
  SparsePattern pattern;
  pattern.n = unknowns;
  pattern.start.assign(1, 0);
  const auto neighbours = upper_neighbours(groups, equation);
  for (std::size_t node = 0; node < equation.size(); ++node) {
    const int first = equation[node];
    if (first < 0) continue;
    for (int i = 0; i < 3; ++i) {
      for (const auto other : neighbours[node])
        for (int k = 0; k < 3; ++k)
          if (equation[to_index(other)] + k >= first + i)
            pattern.row.push_back(equation[to_index(other)] + k);
      pattern.start.push_back(static_cast<int>(pattern.row.size()));
    }
  }
  return pattern;
}

void add_rank_one(const SparsePattern& pattern, const std::vector<int>& equation,
                  std::span<const std::int32_t> nodes, double scale, const double* g,
                  std::vector<double>& values) {
  for (std::size_t b = 0; b < nodes.size(); ++b) {
    const int column = equation[to_index(nodes[b])];
    for (std::size_t a = b; a < nodes.size(); ++a) {
      const int row = equation[to_index(nodes[a])];
      // The three rows of a node follow one another; each column starts one row below the last.
      const int below = pattern.position(row, column) - pattern.start[to_index(column)];
      for (int k = 0; k < 3; ++k) {
        double* value = values.data() + pattern.start[to_index(column + k)] + below - k;
        for (int i = a == b ? k : 0; i < 3; ++i)
          value[i] += scale * g[3 * a + to_index(i)] * g[3 * b + to_index(k)];
      }
    }
  }
}

void symmetric_multiply(const SparsePattern& pattern, const std::vector<double>& values,
                        const double* x, double* y) {
  std::fill(y, y + pattern.n, 0.0);
  for (int column = 0; column < pattern.n; ++column) {
    std::size_t k = to_index(pattern.start[to_index(column)]);
    const std::size_t end = to_index(pattern.start[to_index(column) + 1]);
    const double xc = x[column];
    double sum = values[k] * xc;
    for (++k; k < end; ++k) {
      const int r = pattern.row[k];
      sum += values[k] * x[r];
      y[r] += values[k] * xc;
    }
    y[column] += sum;
  }
}

}  // namespace palpate::fem
