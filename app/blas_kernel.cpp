// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/blas_kernel.hpp"

#include <unistd.h>

#include <cstdlib>

namespace palpate::app {
namespace {

/// Name of the OpenBLAS kernels for this processor; null to leave the choice to OpenBLAS.
const char* kernel_of_processor() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) {
    return "SkylakeX";
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return nullptr;
}

/// True when the variable had no value and now has this one.
bool set_if_absent(const char* name, const char* value) {
  return std::getenv(name) == nullptr && setenv(name, value, 0) == 0;
}

}  // namespace

void ensure_blas_kernel(char** arguments) {
  const char* kernel = kernel_of_processor();
  const bool chosen = kernel != nullptr && set_if_absent("OPENBLAS_CORETYPE", kernel);
  const bool single = set_if_absent("OPENBLAS_NUM_THREADS", "1");
  if (!chosen && !single) return;  // the second time round, or the user's own choice
  execv("/proc/self/exe", arguments);
}

}  // namespace palpate::app
