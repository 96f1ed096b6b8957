// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

namespace palpate::app {

/// Start this program again, once, with the OpenBLAS kernels that suit the processor.
///
/// OpenBLAS chooses its kernels when it is loaded, before main(). The release in Debian 12 (0.3.21)
/// does not recognise recent processors and then takes those of 2004, several times slower. So
/// OPENBLAS_CORETYPE is set from the features of the processor, OPENBLAS_NUM_THREADS to 1 (the
/// sites are what runs in parallel), and the program replaced by itself. Values already set by the
/// user are respected. Returns when there is nothing to change, or when the system refuses: the
/// results are the same, only slower, and the kernel in use is part of the provenance.
/// Must be the first thing main() does: no thread may exist.
void ensure_blas_kernel(char** arguments);

}  // namespace palpate::app
