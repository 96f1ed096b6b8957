// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/cholesky.hpp"

#include <cblas.h>
#include <malloc.h>
#include <omp.h>
#include <suitesparse/SuiteSparse_config.h>
#include <suitesparse/cholmod.h>

#include <algorithm>

#include "fem/factor/large_pages.hpp"
#include "fem/factor/memory.hpp"

namespace palpate::fem {

namespace {

/// CHOLMOD has one allocation function for the whole process.
void put_factors_in_large_pages() {
  static const bool once = [] {
    SuiteSparse_config.malloc_func = allocate_in_large_pages;
    return true;
  }();
  static_cast<void>(once);
}

cholmod_common started_common() {
  put_factors_in_large_pages();
  cholmod_common common;
  cholmod_start(&common);
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.final_ll = 1;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_AMD;
  common.postorder = 1;
  common.print = 0;
  common.quick_return_if_not_posdef = 1;
  return common;
}

}  // namespace

struct SolveWorkspace::Impl {
  cholmod_common common = started_common();
  cholmod_dense* X = nullptr;
  cholmod_dense* Y = nullptr;
  cholmod_dense* E = nullptr;

  ~Impl() {
    cholmod_free_dense(&X, &common);
    cholmod_free_dense(&Y, &common);
    cholmod_free_dense(&E, &common);
    cholmod_finish(&common);
  }
};

SolveWorkspace::SolveWorkspace() : impl_(std::make_unique<Impl>()) {}
SolveWorkspace::~SolveWorkspace() = default;

struct Cholesky::Impl {
  Impl(const SparsePattern& p, std::size_t count) : pattern(p), last(count) {}

  ~Impl() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }

  /// View of the matrix; CHOLMOD takes pointers to non-const but reads only.
  cholmod_sparse view(const double* values) {
    cholmod_sparse A{};
    A.nrow = A.ncol = static_cast<std::size_t>(pattern.n);
    A.nzmax = static_cast<std::size_t>(pattern.nonzeros());
    A.p = pattern.start.data();
    A.i = pattern.row.data();
    A.x = const_cast<double*>(values);
    A.stype = -1;
    A.itype = CHOLMOD_INT;
    A.xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN;
    A.dtype = CHOLMOD_DOUBLE;
    A.sorted = 1;
    A.packed = 1;
    return A;
  }

  /// Minimum degree, the marked unknowns after all others.
  std::vector<int> minimum_degree(cholmod_sparse& A, std::vector<int> marks) {
    std::vector<int> order(A.nrow);
    if (!cholmod_camd(&A, nullptr, 0, marks.data(), order.data(), &common))
      out_of_memory(pattern.n);
    return order;
  }

  void analyze(cholmod_sparse& A, std::vector<int>* order) {
    cholmod_free_factor(&factor, &common);
    common.method[0].ordering = order ? CHOLMOD_GIVEN : CHOLMOD_AMD;
    factor = cholmod_analyze_p(&A, order ? order->data() : nullptr, nullptr, 0, &common);
    if (!factor) out_of_memory(pattern.n);
  }

  const int* permutation() const { return static_cast<const int*>(factor->Perm); }

  bool ends_with(const std::vector<int>& marks) const {
    const int* end = permutation() + pattern.n;
    return std::all_of(end - static_cast<std::ptrdiff_t>(last), end,
                       [&](int unknown) { return marks[static_cast<std::size_t>(unknown)] == 1; });
  }

  /// @return the result, which belongs to the workspace.
  const double* solve(int system, const double* b, SolveWorkspace::Impl& work) const {
    cholmod_dense B{};
    B.nrow = B.d = B.nzmax = static_cast<std::size_t>(pattern.n);
    B.ncol = 1;
    B.x = const_cast<double*>(b);
    B.xtype = CHOLMOD_REAL;
    B.dtype = CHOLMOD_DOUBLE;
    if (!cholmod_solve2(system, factor, &B, nullptr, &work.X, nullptr, &work.Y, &work.E,
                        &work.common))
      out_of_memory(pattern.n);
    return static_cast<const double*>(work.X->x);
  }

  SparsePattern pattern;
  std::size_t last;  ///< number of unknowns that are eliminated last
  cholmod_common common = started_common();
  cholmod_factor* factor = nullptr;
};

Cholesky::Cholesky(const SparsePattern& pattern, const std::vector<int>* permutation,
                   const std::vector<int>& last)
    : impl_(std::make_unique<Impl>(pattern, last.size())) {
  cholmod_sparse A = impl_->view(nullptr);
  std::vector<int> marks(static_cast<std::size_t>(pattern.n), 0);
  for (const int unknown : last) marks[static_cast<std::size_t>(unknown)] = 1;
  std::vector<int> order;
  if (permutation)
    order = *permutation;
  else if (!last.empty())
    order = impl_->minimum_degree(A, marks);
  std::stable_partition(order.begin(), order.end(),
                        [&](int unknown) { return marks[static_cast<std::size_t>(unknown)] == 0; });
  impl_->analyze(A, order.empty() ? nullptr : &order);
  if (impl_->ends_with(marks)) return;
  // A body in parts: postordering the elimination tree has put one part after the marked unknowns.
  impl_->common.postorder = 0;
  impl_->analyze(A, &order);
}

std::vector<int> nested_dissection(const SparsePattern& pattern) {
  cholmod_common common = started_common();
  cholmod_sparse A{};
  A.nrow = A.ncol = static_cast<std::size_t>(pattern.n);
  A.nzmax = static_cast<std::size_t>(pattern.nonzeros());
  A.p = const_cast<int*>(pattern.start.data());
  A.i = const_cast<int*>(pattern.row.data());
  A.stype = -1;
  A.itype = CHOLMOD_INT;
  A.xtype = CHOLMOD_PATTERN;
  A.dtype = CHOLMOD_DOUBLE;
  A.sorted = A.packed = 1;
  std::vector<int> permutation(static_cast<std::size_t>(pattern.n));
  const int done = cholmod_metis(&A, nullptr, 0, 1, permutation.data(), &common);
  cholmod_finish(&common);
  if (!done) out_of_memory(pattern.n);
  return permutation;
}

Cholesky::~Cholesky() = default;

bool Cholesky::factorize(const std::vector<double>& values) {
  cholmod_sparse A = impl_->view(values.data());
  cholmod_factorize(&A, impl_->factor, &impl_->common);
  if (impl_->common.status == CHOLMOD_OUT_OF_MEMORY) out_of_memory(impl_->pattern.n);
  return impl_->common.status == CHOLMOD_OK;
}

void Cholesky::solve(const double* b, double* x, SolveWorkspace& workspace) const {
  const double* result = impl_->solve(CHOLMOD_A, b, *workspace.impl_);
  std::copy(result, result + impl_->pattern.n, x);
}

std::vector<int> Cholesky::last_unknowns() const {
  const int* end = impl_->permutation() + impl_->pattern.n;
  return {end - static_cast<std::ptrdiff_t>(impl_->last), end};
}

double Cholesky::bytes() const {
  return static_cast<double>(impl_->factor->xsize) * sizeof(double);
}

SupernodalView Cholesky::view() const {
  const cholmod_factor& L = *impl_->factor;
  SupernodalView view;
  view.supernodes = static_cast<int>(L.nsuper);
  view.permutation = impl_->permutation();
  view.first_column = static_cast<const int*>(L.super);
  view.row_start = static_cast<const int*>(L.pi);
  view.value_start = static_cast<const int*>(L.px);
  view.rows = static_cast<const int*>(L.s);
  view.values = static_cast<const double*>(L.x);
  return view;
}

std::string blas_kernel() {
  return openblas_get_corename();
}

std::string solver_versions() {
  int version[3];
  cholmod_version(version);
  return "CHOLMOD " + std::to_string(version[0]) + "." + std::to_string(version[1]) + "." +
         std::to_string(version[2]) + ", " + openblas_get_config();
}

void use_one_thread_per_site() {
  openblas_set_num_threads(1);
  // CHOLMOD requests four threads in its own loops, whatever omp_set_num_threads says.
  omp_set_max_active_levels(0);
  // Every factorization allocates and frees work arrays of megabytes: keep them in the process.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest value that takes effect
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

}  // namespace palpate::fem
