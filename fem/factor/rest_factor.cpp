// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/rest_factor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

#include "fem/factor/multifrontal.hpp"
#include "format/error.hpp"
#include "format/to_index.hpp"

namespace palpate::fem {

namespace {

/// A factor whose solutions of test loads are off by more, over the solutions, is computed again in
/// double precision: it would cost iterations.
constexpr double kMostErrorOfSolutions = 0.03;

#if defined(__AVX512F__)
constexpr int kRegister = 16;
#elif defined(__AVX__)
constexpr int kRegister = 8;
#else
constexpr int kRegister = 4;
#endif
/// Numbers in a register.
typedef float Register
    __attribute__((vector_size(kRegister * sizeof(float)), aligned(4), may_alias));
/// Columns of a panel whose unknowns stay in registers, beside what is subtracted from them, while
/// its rows pass.
constexpr int kColumnsAtOnce = kRegister == kBatch ? 16 : 4;
/// Rows that stay in the first cache while the columns of a panel take turns.
constexpr int kRowsAtOnce = kRegister == kBatch ? std::numeric_limits<int>::max() : 64;

/// One right-hand side in each lane; in parts, as GCC keeps vectors wider than registers in memory.
struct Pack {
  static constexpr int kParts = kBatch / kRegister;
  Register part[kParts];

  static Pack at(const float* y) {
    Pack p;
    for (Register& own : p.part) {
      own = *reinterpret_cast<const Register*>(y);
      y += kRegister;
    }
    return p;
  }
  void store(float* y) const {
    for (const Register& own : part) {
      *reinterpret_cast<Register*>(y) = own;
      y += kRegister;
    }
  }
  void subtract(float factor, const Pack& other) {
    for (int i = 0; i < kParts; ++i) part[i] -= factor * other.part[i];
  }
  void multiply(float factor) {
    for (int i = 0; i < kParts; ++i) part[i] *= factor;
  }
};

inline float* pack(float* y, int row) {
  return y + to_index(row) * kBatch;
}

// A supernode is stored as panels of up to sixteen columns, one after the other, each by rows: its
// own triangle as a square, then every row of the supernode below that. Both sweeps thus read the
// factor from end to end, and a row of the right-hand sides once for all columns of a panel.

/// Calls work.operator()<W>(first column) for the panels of a supernode, widest first; backwards
/// when asked.
template <class Work>
void for_panels(int columns, Work&& work) {
  int first = 0;
  for (; first + 16 <= columns; first += 16) work.template operator()<16>(first);
  const int rest = columns - first;
  if (rest & 8) work.template operator()<8>(first), first += 8;
  if (rest & 4) work.template operator()<4>(first), first += 4;
  if (rest & 2) work.template operator()<2>(first), first += 2;
  if (rest & 1) work.template operator()<1>(first);
}

template <class Work>
void for_panels_backward(int columns, Work&& work) {
  int end = columns;
  if (columns & 1) work.template operator()<1>(end -= 1);
  if (columns & 2) work.template operator()<2>(end -= 2);
  if (columns & 4) work.template operator()<4>(end -= 4);
  if (columns & 8) work.template operator()<8>(end -= 8);
  while (end > 0) work.template operator()<16>(end -= 16);
}

/// Numbers in the panels of a supernode with `rows` rows below.
std::size_t panel_numbers(int columns, int rows) {
  std::size_t total = 0;
  for_panels(columns,
             [&]<int W>(int first) { total += to_index(W) * to_index(columns - first + rows); });
  return total;
}

/// L x = y for the columns of a panel, whose unknowns start at `own`; `inside` more unknowns of the
/// supernode follow them, then those listed in `rows`.
template <int W>
void forward_panel(const float* panel, float* own, int inside, const int* rows, int below,
                   float* y) {
  Pack x[W];
  for (int k = 0; k < W; ++k, panel += W) {
    x[k] = Pack::at(pack(own, k));
    for (int j = 0; j < k; ++j) x[k].subtract(panel[j], x[j]);
    x[k].multiply(1.0f / panel[k]);
    x[k].store(pack(own, k));
  }
  const auto subtract_from = [&](float* target) {
    Pack sum = Pack::at(target);
    for (int k = 0; k < W; ++k) sum.subtract(panel[k], x[k]);
    sum.store(target);
    panel += W;
  };
  for (int r = 0; r < inside; ++r) subtract_from(pack(own, W + r));
  for (int r = 0; r < below; ++r) subtract_from(pack(y, rows[r]));
}

/// Subtracts from the unknowns of a panel the products of `count` rows and the solutions there,
/// which are at solution(row).
template <int W, class Solution>
void subtract_rows(const float* row, int count, Solution&& solution, float* own) {
  constexpr int kColumns = std::min(W, kColumnsAtOnce);
  for (int begin = 0; begin < count;) {
    const int end = begin + std::min(count - begin, kRowsAtOnce);
    for (int first = 0; first < W; first += kColumns) {
      Pack x[kColumns];
      for (int k = 0; k < kColumns; ++k) x[k] = Pack::at(pack(own, first + k));
      for (int r = begin; r < end; ++r) {
        const Pack below = Pack::at(solution(r));
        const float* factor = row + to_index(r) * to_index(W) + first;
        for (int k = 0; k < kColumns; ++k) x[k].subtract(factor[k], below);
      }
      for (int k = 0; k < kColumns; ++k) x[k].store(pack(own, first + k));
    }
    begin = end;
  }
}

/// The same for L^T x = y.
template <int W>
void backward_panel(const float* panel, float* own, int inside, const int* rows, int below,
                    float* y) {
  const float* row = panel + to_index(W) * to_index(W);
  subtract_rows<W>(
      row, inside, [&](int r) { return pack(own, W + r); }, own);
  row += to_index(W) * to_index(inside);
  subtract_rows<W>(
      row, below, [&](int r) { return pack(y, rows[r]); }, own);
  for (int k = W; k-- > 0;) {
    Pack x = Pack::at(pack(own, k));
    for (int j = k + 1; j < W; ++j) x.subtract(panel[j * W + k], Pack::at(pack(own, j)));
    x.multiply(1.0f / panel[k * W + k]);
    x.store(pack(own, k));
  }
}

}  // namespace

RestFactor::RestFactor(const SparsePattern& pattern, const std::vector<int>& permutation,
                       const std::vector<double>& values, const std::string& owner,
                       const FactorResources& resources)
    : n_(pattern.n) {
  const Cholesky analysis(pattern, &permutation);
  const SupernodalView view = analysis.view();
  permutation_.assign(view.permutation, view.permutation + n_);
  std::size_t total = 0;
  for (int k = 0; k < view.supernodes; ++k) {
    const int columns = view.first_column[k + 1] - view.first_column[k];
    const int rows = view.row_start[k + 1] - view.row_start[k];
    supernodes_.push_back({view.first_column[k], columns, rows - columns, rows_.size(), total});
    rows_.insert(rows_.end(), view.rows + view.row_start[k] + columns,
                 view.rows + view.row_start[k + 1]);
    total += panel_numbers(columns, rows - columns);
  }
  const Multifrontal fronts(pattern, view);
  try {
    values_.resize(total);
    if (factorize<float>(fronts, values, resources) &&
        error_of_solutions(pattern, values) < kMostErrorOfSolutions)
      return;
    in_double_precision_ = true;
    if (!factorize<double>(fronts, values, resources))
      throw Error(ErrorKind::Geometry, owner,
                  "the stiffness of the body at rest is not positive definite",
                  "check the supports and that the mesh is in one piece");
  } catch (const std::bad_alloc&) {
    out_of_memory(n_);
  }
}

template <class Number>
bool RestFactor::factorize(const Multifrontal& fronts, const std::vector<double>& values,
                           const FactorResources& resources) {
  const int threads =
      threads_that_fit(resources, [&](int t) { return bytes() + fronts.working_bytes<Number>(t); });
  const Multifrontal::Finished<Number> finished = [this](int k, const Number* x) { store(k, x); };
  return fronts.factorize(values, threads, finished);
}

double RestFactor::error_of_solutions(const SparsePattern& pattern,
                                      const std::vector<double>& values) const {
  // A smooth load, which shows the softest modes, and rougher ones.
  const auto n = static_cast<Eigen::Index>(n_);
  Eigen::MatrixXd load(n, kBatch), Kx(n, kBatch);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < kBatch; ++j) load(i, j) = std::cos(static_cast<double>(i * j));
  std::vector<float> scratch;
  const auto solution = [&](const Eigen::MatrixXd& of) {
    std::vector<float> block(to_index(n_) * kBatch);
    Eigen::Map<Eigen::Matrix<float, Eigen::Dynamic, kBatch, Eigen::RowMajor>> x(block.data(), n,
                                                                                kBatch);
    x = of.cast<float>();
    solve(block, scratch);
    return Eigen::MatrixXd(x.cast<double>());
  };
  const Eigen::MatrixXd x = solution(load);
  for (Eigen::Index j = 0; j < kBatch; ++j)
    symmetric_multiply(pattern, values, x.col(j).data(), Kx.col(j).data());
  const Eigen::MatrixXd error = solution(load - Kx);
  const double worst = (error.colwise().norm().array() / x.colwise().norm().array()).maxCoeff();
  return std::isfinite(worst) ? worst : std::numeric_limits<double>::infinity();
}

template <class Number>
void RestFactor::store(int supernode, const Number* columns) {
  const Supernode& node = supernodes_[to_index(supernode)];
  const int rows = node.columns + node.rows_below;
  float* to = values_.data() + node.values;
  for_panels(node.columns, [&]<int W>(int first) {
    for (int i = first; i < rows; ++i)
      for (int j = first; j < first + W; ++j)
        *to++ =
            static_cast<float>(i >= j ? columns[to_index(j) * to_index(rows) + to_index(i)] : 0);
  });
}

void RestFactor::forward(float* y) const {
  for (const Supernode& node : supernodes_) {
    float* x = y + to_index(node.first_column) * kBatch;
    const float* panel = values_.data() + node.values;
    for_panels(node.columns, [&]<int W>(int first) {
      const int inside = node.columns - first - W;
      forward_panel<W>(panel, x + to_index(first) * kBatch, inside, rows_.data() + node.row_list,
                       node.rows_below, y);
      panel += to_index(W) * to_index(W + inside + node.rows_below);
    });
  }
}

void RestFactor::backward(float* y) const {
  for (auto node = supernodes_.rbegin(); node != supernodes_.rend(); ++node) {
    float* x = y + to_index(node->first_column) * kBatch;
    const float* panel =
        values_.data() + node->values + panel_numbers(node->columns, node->rows_below);
    for_panels_backward(node->columns, [&]<int W>(int first) {
      const int inside = node->columns - first - W;
      panel -= to_index(W) * to_index(W + inside + node->rows_below);
      backward_panel<W>(panel, x + to_index(first) * kBatch, inside, rows_.data() + node->row_list,
                        node->rows_below, y);
    });
  }
}

void RestFactor::solve(std::vector<float>& block, std::vector<float>& scratch) const {
  scratch.resize(block.size());
  constexpr std::size_t kRow = kBatch * sizeof(float);
  for (int i = 0; i < n_; ++i)
    std::memcpy(&scratch[to_index(i) * kBatch],
                &block[to_index(permutation_[to_index(i)]) * kBatch], kRow);
  forward(scratch.data());
  backward(scratch.data());
  for (int i = 0; i < n_; ++i)
    std::memcpy(&block[to_index(permutation_[to_index(i)]) * kBatch],
                &scratch[to_index(i) * kBatch], kRow);
}

namespace {

/// A factor is reused while the ratios of the new diagonal to the old spread by no more than this.
/// The eigenvalues of the preconditioned matrix are then within about that ratio.
constexpr double kMostSpread = 1.25;

std::vector<double> diagonal_of(const SparsePattern& pattern, const std::vector<double>& values) {
  std::vector<double> diagonal(to_index(pattern.n));
  for (int column = 0; column < pattern.n; ++column)  // the first of the lower triangle
    diagonal[to_index(column)] = values[to_index(pattern.start[to_index(column)])];
  return diagonal;
}

}  // namespace

const std::vector<int>& FactorCache::permutation(const SparsePattern& pattern) {
  if (permutation_.empty()) permutation_ = nested_dissection(pattern);
  return permutation_;
}

std::shared_ptr<const RestFactor> FactorCache::factor_of(const SparsePattern& pattern,
                                                         const std::vector<double>& values,
                                                         const std::string& owner,
                                                         const FactorResources& resources) {
  std::vector<double> diagonal = diagonal_of(pattern, values);
  if (factor_ && diagonal.size() == diagonal_.size()) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (std::size_t i = 0; i < diagonal.size(); ++i) {
      least = std::min(least, diagonal[i] / diagonal_[i]);
      most = std::max(most, diagonal[i] / diagonal_[i]);
    }
    if (least > 0 && most <= kMostSpread * least) {
      const double scale = std::sqrt(least * most);
      factor_->scale(scale / scale_);
      scale_ = scale;
      return factor_;
    }
  }
  factor_.reset();  // its memory is needed
  factor_ = std::make_shared<RestFactor>(pattern, permutation(pattern), values, owner, resources);
  diagonal_ = std::move(diagonal);
  scale_ = 1;
  ++factorizations_;
  return factor_;
}

}  // namespace palpate::fem
