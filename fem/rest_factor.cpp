// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/rest_factor.hpp"

#include <algorithm>
#include <cstring>

#include "fem/at.hpp"
#include "format/error.hpp"

namespace palpate::fem {

namespace {

/// One right-hand side in each lane; the compiler splits it where registers are narrower.
typedef float Pack __attribute__((vector_size(kBatch * sizeof(float)), aligned(4), may_alias));

inline Pack& pack(float* y, int row) {
  return *reinterpret_cast<Pack*>(y + at(row) * kBatch);
}

/// A row of a dense block stored by rows.
inline const float* row_of(const float* block, int row, int columns) {
  return block + at(row) * at(columns);
}

/// Dense lower triangle L (by rows) times its unknowns = y, in place.
void solve_lower(const float* L, int n, float* y) {
  for (int i = 0; i < n; ++i) {
    const float* row = row_of(L, i, n);
    Pack sum = pack(y, i);
    for (int j = 0; j < i; ++j) sum -= row[j] * pack(y, j);
    pack(y, i) = sum * (1.0f / row[i]);
  }
}

/// Transposed: L^T x = y, in place.
void solve_lower_transposed(const float* L, int n, float* y) {
  for (int i = n - 1; i >= 0; --i) {
    const float* row = row_of(L, i, n);
    const Pack x = pack(y, i) * (1.0f / row[i]);
    pack(y, i) = x;
    for (int j = 0; j < i; ++j) pack(y, j) -= row[j] * x;
  }
}

/// y[rows] -= B x for the rows below a supernode, four at a time so that x is read once for them.
void subtract_below(const float* B, int columns, const int* rows, int count, const float* x,
                    float* y) {
  int r = 0;
  auto* xp = const_cast<float*>(x);
  for (; r + 4 <= count; r += 4) {
    const float* b0 = row_of(B, r, columns);
    const float *b1 = b0 + columns, *b2 = b1 + columns, *b3 = b2 + columns;
    Pack s0 = pack(y, rows[r]), s1 = pack(y, rows[r + 1]), s2 = pack(y, rows[r + 2]),
         s3 = pack(y, rows[r + 3]);
    for (int j = 0; j < columns; ++j) {
      const Pack v = pack(xp, j);
      s0 -= b0[j] * v;
      s1 -= b1[j] * v;
      s2 -= b2[j] * v;
      s3 -= b3[j] * v;
    }
    pack(y, rows[r]) = s0;
    pack(y, rows[r + 1]) = s1;
    pack(y, rows[r + 2]) = s2;
    pack(y, rows[r + 3]) = s3;
  }
  for (; r < count; ++r) {
    const float* b = row_of(B, r, columns);
    Pack s = pack(y, rows[r]);
    for (int j = 0; j < columns; ++j) s -= b[j] * pack(xp, j);
    pack(y, rows[r]) = s;
  }
}

/// x -= B^T y[rows], four columns at a time.
void subtract_above(const float* B, int columns, const int* rows, int count, float* y, float* x) {
  int j = 0;
  for (; j + 4 <= columns; j += 4) {
    Pack s0 = pack(x, j), s1 = pack(x, j + 1), s2 = pack(x, j + 2), s3 = pack(x, j + 3);
    for (int r = 0; r < count; ++r) {
      const float* b = row_of(B, r, columns) + j;
      const Pack v = pack(y, rows[r]);
      s0 -= b[0] * v;
      s1 -= b[1] * v;
      s2 -= b[2] * v;
      s3 -= b[3] * v;
    }
    pack(x, j) = s0;
    pack(x, j + 1) = s1;
    pack(x, j + 2) = s2;
    pack(x, j + 3) = s3;
  }
  for (; j < columns; ++j) {
    Pack s = pack(x, j);
    for (int r = 0; r < count; ++r) s -= row_of(B, r, columns)[j] * pack(y, rows[r]);
    pack(x, j) = s;
  }
}

}  // namespace

RestFactor::RestFactor(const SparsePattern& pattern, const std::vector<int>& permutation,
                       const std::vector<double>& values, const std::string& owner)
    : n_(pattern.n) {
  Cholesky factor(pattern, &permutation);
  if (!factor.factorize(values))
    throw Error(ErrorKind::Geometry, owner, "the body at rest is not stiff in every direction",
                "check the supports and that the mesh is in one piece");
  const SupernodalView view = factor.view();
  permutation_.assign(view.permutation, view.permutation + n_);
  for (int k = 0; k < view.supernodes; ++k) {
    const int columns = view.first_column[k + 1] - view.first_column[k];
    const int rows = view.row_start[k + 1] - view.row_start[k];
    Supernode node{view.first_column[k], columns, rows - columns, rows_.size(), values_.size()};
    const double* x = view.values + view.value_start[k];
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j)
        values_.push_back(static_cast<float>(i >= j ? x[at(j) * at(rows) + at(i)] : 0));
    rows_.insert(rows_.end(), view.rows + view.row_start[k] + columns,
                 view.rows + view.row_start[k + 1]);
    supernodes_.push_back(node);
  }
}

void RestFactor::forward(float* y) const {
  for (const Supernode& node : supernodes_) {
    float* x = y + at(node.first_column) * kBatch;
    const float* L = values_.data() + node.values;
    solve_lower(L, node.columns, x);
    subtract_below(row_of(L, node.columns, node.columns), node.columns,
                   rows_.data() + node.row_list, node.rows_below, x, y);
  }
}

void RestFactor::backward(float* y) const {
  for (auto node = supernodes_.rbegin(); node != supernodes_.rend(); ++node) {
    float* x = y + at(node->first_column) * kBatch;
    const float* L = values_.data() + node->values;
    subtract_above(row_of(L, node->columns, node->columns), node->columns,
                   rows_.data() + node->row_list, node->rows_below, y, x);
    solve_lower_transposed(L, node->columns, x);
  }
}

void RestFactor::solve(std::vector<float>& block, std::vector<float>& scratch) const {
  scratch.resize(block.size());
  constexpr std::size_t kRow = kBatch * sizeof(float);
  for (int i = 0; i < n_; ++i)
    std::memcpy(&scratch[at(i) * kBatch], &block[at(permutation_[at(i)]) * kBatch], kRow);
  forward(scratch.data());
  backward(scratch.data());
  for (int i = 0; i < n_; ++i)
    std::memcpy(&block[at(permutation_[at(i)]) * kBatch], &scratch[at(i) * kBatch], kRow);
}

SolveBatch::SolveBatch(const RestFactor& factor, int members)
    : factor_(factor), members_(members), block_(at(factor.size()) * kBatch, 0.0f) {}

void SolveBatch::serve_if_all_wait() {
  if (waiting_ == 0 || waiting_ < members_) return;
  factor_.solve(block_, scratch_);
  waiting_ = 0;
  ++generation_;
  served_.notify_all();
}

SolveBatch::Member::Member(SolveBatch& batch, int lane)
    : batch_(batch), lane_(lane), lock_(batch.mutex_) {}

SolveBatch::Member::~Member() {
  --batch_.members_;
  batch_.serve_if_all_wait();
}

void SolveBatch::Member::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  // Scaled to unit length: residuals near convergence would lose bits to the range of a float.
  const double length = b.norm();
  x.setZero(b.size());
  if (length == 0) return;
  float* lane = batch_.block_.data() + lane_;
  for (Eigen::Index i = 0; i < b.size(); ++i) lane[i * kBatch] = static_cast<float>(b[i] / length);
  ++batch_.waiting_;
  const std::uint64_t mine = batch_.generation_;
  batch_.serve_if_all_wait();
  batch_.served_.wait(lock_, [&] { return batch_.generation_ != mine; });
  for (Eigen::Index i = 0; i < b.size(); ++i) x[i] = length * lane[i * kBatch];
}

}  // namespace palpate::fem
