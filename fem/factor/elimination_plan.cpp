// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/elimination_plan.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// The largest part has at most the work of a thread over this.
constexpr double kPartsPerThread = 2;

double square(int rows) {
  return static_cast<double>(rows) * rows;
}

double numbers_in_columns(const EliminationTree& tree, int k) {
  return static_cast<double>(tree.columns[to_index(k)]) * tree.rows[to_index(k)];
}

/// Work of each supernode and all its descendants.
std::vector<double> work_of_subtrees(const EliminationTree& tree) {
  std::vector<double> work(tree.parent.size());
  for (int k = 0; k < tree.supernodes(); ++k) {
    work[to_index(k)] += tree.work(k);
    if (const int parent = tree.parent[to_index(k)]; parent >= 0)
      work[to_index(parent)] += work[to_index(k)];
  }
  return work;
}

/// Roots of subtrees of at most `most` work, and the supernodes above them.
std::pair<std::vector<int>, std::vector<int>> split_tree(const EliminationTree& tree,
                                                         const std::vector<double>& work,
                                                         double most) {
  std::vector<int> open, roots, top;
  for (int k = 0; k < tree.supernodes(); ++k)
    if (tree.parent[to_index(k)] < 0) open.push_back(k);
  while (!open.empty()) {
    const int k = open.back();
    open.pop_back();
    if (work[to_index(k)] <= most || tree.children[to_index(k)].empty()) {
      roots.push_back(k);
      continue;
    }
    top.push_back(k);
    open.insert(open.end(), tree.children[to_index(k)].begin(), tree.children[to_index(k)].end());
  }
  std::sort(top.begin(), top.end());
  return {roots, top};
}

/// Peak memory of the updates while one thread eliminates these supernodes.
double peak_numbers(const EliminationTree& tree, const std::vector<int>& part) {
  double live = 0, peak = 0;
  for (const int k : part) {
    live += square(tree.below(k));
    peak = std::max(peak, live);
    for (const int child : tree.children[to_index(k)]) live -= square(tree.below(child));
  }
  return peak;
}

}  // namespace

EliminationTree::EliminationTree(const SupernodalView& view) {
  const int count = view.supernodes;
  std::vector<int> supernode_of_column;
  for (int k = 0; k < count; ++k) {
    columns.push_back(view.first_column[k + 1] - view.first_column[k]);
    rows.push_back(view.row_start[k + 1] - view.row_start[k]);
    supernode_of_column.insert(supernode_of_column.end(), to_index(columns.back()), k);
  }
  parent.assign(to_index(count), -1);
  children.resize(to_index(count));
  for (int k = 0; k < count; ++k) {
    if (below(k) == 0) continue;
    const int first_below = view.rows[view.row_start[k] + columns[to_index(k)]];
    if (to_index(first_below) >= supernode_of_column.size()) continue;
    parent[to_index(k)] = supernode_of_column[to_index(first_below)];
    children[to_index(parent[to_index(k)])].push_back(k);
  }
}

int EliminationTree::below(int supernode) const {
  return rows[to_index(supernode)] - columns[to_index(supernode)];
}

double EliminationTree::work(int supernode) const {
  double sum = 0;
  for (int j = 0; j < columns[to_index(supernode)]; ++j) {
    const double left = rows[to_index(supernode)] - j;
    sum += 0.5 * left * left;
  }
  return sum;
}

EliminationPlan::EliminationPlan(const EliminationTree& tree, int threads) {
  if (tree.supernodes() == 0) return;
  for (int k = 0; k < tree.supernodes(); ++k)
    column_numbers = std::max(column_numbers, threads * numbers_in_columns(tree, k));
  const std::vector<double> work = work_of_subtrees(tree);
  double whole = 0;
  for (int k = 0; k < tree.supernodes(); ++k)
    if (tree.parent[to_index(k)] < 0) whole += work[to_index(k)];
  if (threads == 1) {
    parts.emplace_back(to_index(tree.supernodes()));
    std::iota(parts.back().begin(), parts.back().end(), 0);
    update_numbers = peak_numbers(tree, parts.back());
    return;
  }
  std::vector<int> roots;
  std::tie(roots, top) = split_tree(tree, work, whole / (kPartsPerThread * threads));
  std::stable_sort(roots.begin(), roots.end(),
                   [&](int a, int b) { return work[to_index(a)] > work[to_index(b)]; });
  std::vector<int> part_of(tree.parent.size(), -1);
  for (std::size_t i = 0; i < roots.size(); ++i) part_of[to_index(roots[i])] = static_cast<int>(i);
  for (int k = tree.supernodes(); k-- > 0;)
    if (part_of[to_index(k)] < 0 && tree.parent[to_index(k)] >= 0)
      part_of[to_index(k)] = part_of[to_index(tree.parent[to_index(k)])];
  parts.resize(roots.size());
  for (int k = 0; k < tree.supernodes(); ++k)
    if (part_of[to_index(k)] >= 0) parts[to_index(part_of[to_index(k)])].push_back(k);

  std::vector<double> peaks;
  for (const auto& part : parts) peaks.push_back(peak_numbers(tree, part));
  std::sort(peaks.begin(), peaks.end(), std::greater<>());
  peaks.resize(std::min(peaks.size(), to_index(threads)));
  update_numbers = std::accumulate(peaks.begin(), peaks.end(), 0.0);
  for (const int root : roots) update_numbers += square(tree.below(root));
  for (const int k : top) update_numbers += square(tree.below(k));
}

}  // namespace palpate::fem
