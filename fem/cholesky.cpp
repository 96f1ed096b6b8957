// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/cholesky.hpp"

#include <cblas.h>
#include <malloc.h>
#include <omp.h>
#include <suitesparse/cholmod.h>

#include <algorithm>

#include "format/error.hpp"

namespace palpate::fem {

namespace {

cholmod_common started_common() {
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

[[noreturn]] void out_of_memory(int n) {
  throw Error(ErrorKind::Internal, "stiffness factorization",
              "not enough memory for " + std::to_string(n) + " unknowns",
              "use a coarser mesh, fewer threads, or a machine with more memory");
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
  explicit Impl(const SparsePattern& p) : pattern(p) {}

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

  SparsePattern pattern;
  cholmod_common common = started_common();
  cholmod_factor* factor = nullptr;
};

Cholesky::Cholesky(const SparsePattern& pattern, const std::vector<int>* permutation)
    : impl_(std::make_unique<Impl>(pattern)) {
  cholmod_sparse A = impl_->view(nullptr);
  if (permutation) {
    impl_->common.method[0].ordering = CHOLMOD_GIVEN;
    impl_->factor =
        cholmod_analyze_p(&A, const_cast<int*>(permutation->data()), nullptr, 0, &impl_->common);
  } else {
    impl_->factor = cholmod_analyze(&A, &impl_->common);
  }
  if (!impl_->factor) out_of_memory(pattern.n);
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
  SolveWorkspace::Impl& work = *workspace.impl_;
  const auto n = static_cast<std::size_t>(impl_->pattern.n);
  cholmod_dense B{};
  B.nrow = B.d = B.nzmax = n;
  B.ncol = 1;
  B.x = const_cast<double*>(b);
  B.xtype = CHOLMOD_REAL;
  B.dtype = CHOLMOD_DOUBLE;
  if (!cholmod_solve2(CHOLMOD_A, impl_->factor, &B, nullptr, &work.X, nullptr, &work.Y, &work.E,
                      &work.common))
    out_of_memory(impl_->pattern.n);
  const auto* result = static_cast<const double*>(work.X->x);
  std::copy(result, result + n, x);
}

SupernodalView Cholesky::view() const {
  const cholmod_factor& L = *impl_->factor;
  SupernodalView view;
  view.supernodes = static_cast<int>(L.nsuper);
  view.permutation = static_cast<const int*>(L.Perm);
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
  // CHOLMOD asks for four threads in its own loops, whatever omp_set_num_threads says.
  omp_set_max_active_levels(0);
  // Work arrays of megabytes come and go with every factorization: keep them in the process.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest that is heeded
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

}  // namespace palpate::fem
