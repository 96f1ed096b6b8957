// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/partial_factor.hpp"

#include <algorithm>
#include <new>

#include "fem/factor/blas.hpp"
#include "fem/factor/memory.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

PartialFactor::Cut::Cut(const SupernodalView& whole, int unknowns, int kept)
    : permutation(whole.permutation, whole.permutation + unknowns) {
  const int eliminated = unknowns - kept;
  for (int k = 0; k < whole.supernodes && whole.first_column[k] < eliminated; ++k) {
    first_column.push_back(whole.first_column[k]);
    row_start.push_back(static_cast<int>(rows.size()));
    rows.insert(rows.end(), whole.rows + whole.row_start[k], whole.rows + whole.row_start[k + 1]);
  }
  first_column.push_back(eliminated);
  row_start.push_back(static_cast<int>(rows.size()));
}

SupernodalView PartialFactor::Cut::view() const {
  SupernodalView view;
  view.supernodes = static_cast<int>(first_column.size()) - 1;
  view.permutation = permutation.data();
  view.first_column = first_column.data();
  view.row_start = row_start.data();
  view.rows = rows.data();
  return view;
}

PartialFactor::PartialFactor(const SparsePattern& pattern, const Cholesky& analysis,
                             SharedFronts* fronts)
    : kept_(analysis.last_unknowns()),
      cut_(analysis.view(), pattern.n, static_cast<int>(kept_.size())),
      fronts_(pattern, cut_.view()),
      shared_(fronts),
      start_(1, 0) {
  for (int k = 0; k < cut_.view().supernodes; ++k)
    start_.push_back(start_.back() + to_index(columns(k)) * to_index(rows(k)));
  std::vector<int> in_S(to_index(pattern.n), -1);
  for (std::size_t i = 0; i < kept_.size(); ++i) in_S[to_index(kept_[i])] = static_cast<int>(i);
  for (const int unknown : kept_)
    for (int e = pattern.start[to_index(unknown)]; e < pattern.start[to_index(unknown) + 1]; ++e)
      if (const int row = in_S[to_index(pattern.row[to_index(e)])]; row >= 0)
        kept_entries_.push_back({e, row, in_S[to_index(unknown)]});
}

int PartialFactor::columns(int supernode) const {
  return cut_.first_column[to_index(supernode) + 1] - cut_.first_column[to_index(supernode)];
}

int PartialFactor::rows(int supernode) const {
  return cut_.row_start[to_index(supernode) + 1] - cut_.row_start[to_index(supernode)];
}

void PartialFactor::take_kept_block(const std::vector<double>& values) {
  const auto n = static_cast<Eigen::Index>(kept_.size());
  S_.setZero(n, n);
  for (const KeptEntry& entry : kept_entries_)
    S_(std::max(entry.row, entry.column), std::min(entry.row, entry.column)) =
        values[to_index(entry.value)];
}

double PartialFactor::bytes(Precision precision, int threads) const {
  const auto numbers = static_cast<double>(start_.back());
  return precision == Precision::Single
             ? sizeof(float) * numbers + fronts_.working_bytes<float>(threads)
             : sizeof(double) * numbers + fronts_.working_bytes<double>(threads);
}

bool PartialFactor::factorize(const std::vector<double>& values, Precision precision, int threads) {
  precision_ = precision;
  take_kept_block(values);
  const bool definite = precision == Precision::Single
                            ? factorize_columns(values, threads, single_)
                            : factorize_columns(values, threads, double_);
  if (definite) S_.triangularView<Eigen::StrictlyUpper>() = S_.transpose();
  return definite;
}

template <class Number>
bool PartialFactor::factorize_columns(const std::vector<double>& values, int threads,
                                      Columns<Number>& columns) {
  try {
    columns.values.resize(start_.back());
    const Multifrontal::Finished<Number> store = [&](int k, const Number* from) {
      std::copy_n(from, start_[to_index(k) + 1] - start_[to_index(k)],
                  columns.values.data() + start_[to_index(k)]);
    };
    const Multifrontal::Left<Number> add = [this](int k, const Number* update) {
      add_update(k, update);
    };
    SharedFronts& memory = shared_ != nullptr ? *shared_ : own_;
    return fronts_.factorize(values, threads, store, add, &memory.of<Number>());
  } catch (const std::bad_alloc&) {
    out_of_memory(static_cast<int>(cut_.permutation.size()));
  }
}

template <class Number>
void PartialFactor::add_update(int supernode, const Number* update) {
  const int below = rows(supernode) - columns(supernode);
  const int* row = cut_.rows.data() + cut_.row_start[to_index(supernode)] + columns(supernode);
  for (int j = 0; j < below; ++j, update += below) {
    double* to = S_.col(row[j] - eliminated()).data();
    for (int i = j; i < below; ++i) to[row[i] - eliminated()] += static_cast<double>(update[i]);
  }
}

void PartialFactor::solve_forward(const Eigen::VectorXd& b, Eigen::VectorXd& load) {
  if (precision_ == Precision::Single) return forward(b, single_, load);
  forward(b, double_, load);
}

void PartialFactor::solve_backward(const Eigen::VectorXd& on_kept, Eigen::VectorXd& x) {
  if (precision_ == Precision::Single) return backward(on_kept, single_, x);
  backward(on_kept, double_, x);
}

template <class Number>
void PartialFactor::forward(const Eigen::VectorXd& b, Columns<Number>& columns_of_L,
                            Eigen::VectorXd& load) const {
  auto& y = columns_of_L.ordered;
  auto& products = columns_of_L.below;
  const Eigen::Map<const Eigen::VectorXi> order(cut_.permutation.data(), b.size());
  y = b(order).template cast<Number>();
  for (int k = 0; k + 1 < static_cast<int>(start_.size()); ++k) {
    const int width = columns(k), height = rows(k), below = height - width;
    const Number* L = columns_of_L.values.data() + start_[to_index(k)];
    Number* own = y.data() + cut_.first_column[to_index(k)];
    Blas<Number>::trsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, width, L, height, own,
                       1);
    if (below == 0) continue;
    products.resize(below);
    Blas<Number>::gemv(CblasColMajor, CblasNoTrans, below, width, 1, L + width, height, own, 1, 0,
                       products.data(), 1);
    const int* row = cut_.rows.data() + cut_.row_start[to_index(k)] + width;
    for (int i = 0; i < below; ++i) y[row[i]] -= products[i];
  }
  load = y.tail(b.size() - eliminated()).template cast<double>();
}

template <class Number>
void PartialFactor::backward(const Eigen::VectorXd& on_kept, Columns<Number>& columns_of_L,
                             Eigen::VectorXd& x) const {
  auto& y = columns_of_L.ordered;
  auto& values = columns_of_L.below;
  y.tail(on_kept.size()) = on_kept.cast<Number>();
  for (int k = static_cast<int>(start_.size()) - 1; k-- > 0;) {
    const int width = columns(k), height = rows(k), below = height - width;
    const Number* L = columns_of_L.values.data() + start_[to_index(k)];
    Number* own = y.data() + cut_.first_column[to_index(k)];
    if (below > 0) {
      values.resize(below);
      const int* row = cut_.rows.data() + cut_.row_start[to_index(k)] + width;
      for (int i = 0; i < below; ++i) values[i] = y[row[i]];
      Blas<Number>::gemv(CblasColMajor, CblasTrans, below, width, -1, L + width, height,
                         values.data(), 1, 1, own, 1);
    }
    Blas<Number>::trsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, width, L, height, own,
                       1);
  }
  x.resize(y.size());
  for (Eigen::Index i = 0; i < y.size(); ++i)
    x[cut_.permutation[static_cast<std::size_t>(i)]] = static_cast<double>(y[i]);
  for (std::size_t i = 0; i < kept_.size(); ++i)
    x[kept_[i]] = on_kept[static_cast<Eigen::Index>(i)];
}

}  // namespace palpate::fem
