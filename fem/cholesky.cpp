// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/cholesky.hpp"

#include <cblas.h>
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
  common.method[0].ordering = CHOLMOD_METIS;
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

Cholesky::Cholesky(const SparsePattern& pattern) : impl_(std::make_unique<Impl>(pattern)) {
  cholmod_sparse A = impl_->view(nullptr);
  impl_->factor = cholmod_analyze(&A, &impl_->common);
  if (!impl_->factor) out_of_memory(pattern.n);
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

double Cholesky::factor_bytes() const {
  return static_cast<double>(impl_->factor->xsize) * sizeof(double);
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
  omp_set_num_threads(1);  // CHOLMOD's own loops; the setting belongs to the calling thread
}

}  // namespace palpate::fem
