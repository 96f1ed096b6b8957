// SPDX-License-Identifier: AGPL-3.0-or-later
// The functions of BLAS by the type of number.
#pragma once

#include <cblas.h>

namespace palpate::fem {

template <class Number>
struct Blas;
template <>
struct Blas<double> {
  static constexpr auto trsm = cblas_dtrsm;
  static constexpr auto syrk = cblas_dsyrk;
  static constexpr auto gemm = cblas_dgemm;
  static constexpr auto trsv = cblas_dtrsv;
  static constexpr auto gemv = cblas_dgemv;
};
template <>
struct Blas<float> {
  static constexpr auto trsm = cblas_strsm;
  static constexpr auto syrk = cblas_ssyrk;
  static constexpr auto gemm = cblas_sgemm;
  static constexpr auto trsv = cblas_strsv;
  static constexpr auto gemv = cblas_sgemv;
};

}  // namespace palpate::fem
