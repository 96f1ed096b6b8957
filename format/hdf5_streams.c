/* SPDX-License-Identifier: Apache-2.0 */
/* The streams of the C library under the names that they have in the private copy of HDF5
 * (cmake/hdf5.cmake). */
#include <stdio.h>

#define HIDDEN __attribute__((visibility("hidden")))

extern FILE* palpate_hdf5_stdout;
extern FILE* palpate_hdf5_stderr;
HIDDEN FILE* palpate_hdf5_stdout;
HIDDEN FILE* palpate_hdf5_stderr;

__attribute__((constructor)) static void set_streams(void) {
  palpate_hdf5_stdout = stdout;
  palpate_hdf5_stderr = stderr;
}
