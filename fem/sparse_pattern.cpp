// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/sparse_pattern.hpp"

#include <algorithm>
#include <cassert>

namespace palpate::fem {

namespace {

/// For each node with unknowns, the neighbours of equal or higher number, ascending.
std::vector<std::vector<std::int32_t>> upper_neighbours(const QuadraticMesh& mesh) {
  std::vector<std::vector<std::int32_t>> neighbours(mesh.nodes());
  for (const auto& element : mesh.tetrahedra)
    for (const auto a : element) {
      if (mesh.equation[a] < 0) continue;
      for (const auto b : element)
        if (b >= a && mesh.equation[b] >= 0) neighbours[a].push_back(b);
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
  const auto first = row.begin() + start[column], last = row.begin() + start[column + 1];
  const auto found = std::lower_bound(first, last, target);
  assert(found != last && *found == target);
  return static_cast<int>(found - row.begin());
}

SparsePattern stiffness_pattern(const QuadraticMesh& mesh) {
  SparsePattern pattern;
  pattern.n = mesh.unknowns;
  pattern.start.assign(1, 0);
  const auto neighbours = upper_neighbours(mesh);
  for (int node = 0; node < mesh.nodes(); ++node) {
    const int first = mesh.equation[node];
    if (first < 0) continue;
    for (int i = 0; i < 3; ++i) {
      for (const auto other : neighbours[node])
        for (int k = 0; k < 3; ++k)
          if (mesh.equation[other] + k >= first + i)
            pattern.row.push_back(mesh.equation[other] + k);
      pattern.start.push_back(static_cast<int>(pattern.row.size()));
    }
  }
  return pattern;
}

Submatrix principal_submatrix(const SparsePattern& full, const std::vector<int>& unknowns) {
  Submatrix sub;
  sub.unknown = unknowns;
  sub.pattern.n = static_cast<int>(unknowns.size());
  sub.pattern.start.assign(1, 0);
  std::vector<int> local(full.n, -1);
  for (int i = 0; i < sub.pattern.n; ++i) local[unknowns[i]] = i;
  for (const int column : unknowns) {
    for (int at = full.start[column]; at < full.start[column + 1]; ++at) {
      if (local[full.row[at]] < 0) continue;
      sub.pattern.row.push_back(local[full.row[at]]);
      sub.source.push_back(at);
    }
    sub.pattern.start.push_back(static_cast<int>(sub.pattern.row.size()));
  }
  return sub;
}

void symmetric_multiply(const SparsePattern& pattern, const std::vector<double>& values,
                        const double* x, double* y) {
  std::fill(y, y + pattern.n, 0.0);
  for (int column = 0; column < pattern.n; ++column) {
    int at = pattern.start[column];
    const double xc = x[column];
    double sum = values[at] * xc;
    for (++at; at < pattern.start[column + 1]; ++at) {
      const int r = pattern.row[at];
      sum += values[at] * x[r];
      y[r] += values[at] * xc;
    }
    y[column] += sum;
  }
}

}  // namespace palpate::fem
