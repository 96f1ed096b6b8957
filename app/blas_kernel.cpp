// SPDX-License-Identifier: AGPL-3.0-or-later
#include "app/blas_kernel.hpp"

#include <pthread.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>

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

/// The system calls a program "exe" that was started as /proc/self/exe; `top` and `pkill` shall
/// find it by the name that it was given.
void restore_name(const char* given) {
  if (given == nullptr) return;
  const char* folder_end = std::strrchr(given, '/');
  pthread_setname_np(pthread_self(), folder_end == nullptr ? given : folder_end + 1);
}

}  // namespace

void ensure_blas_kernel(char** arguments) {
  const char* kernel = kernel_of_processor();
  const bool chosen = kernel != nullptr && set_if_absent("OPENBLAS_CORETYPE", kernel);
  const bool single = set_if_absent("OPENBLAS_NUM_THREADS", "1");
  // The second time round, or the user's own choice.
  if (!chosen && !single) return restore_name(arguments[0]);
  execv("/proc/self/exe", arguments);
}

}  // namespace palpate::app
