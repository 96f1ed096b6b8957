// SPDX-License-Identifier: AGPL-3.0-or-later
// Memory of the process, and the bound that a user may set on it.
#pragma once

#include <functional>
#include <string>

namespace palpate::fem {

/// Resident memory of this process, bytes.
double resident_bytes();

/// Memory of the machine, bytes.
double machine_bytes();

/// How often `each` bytes, for one `what`, fit into `bound` beside the resident memory and
/// `reserved` bytes; at most `wanted`. `bound`: bytes, 0 for none.
/// @throws Error(Configuration) when they do not fit once.
int fitting_times(double bound, double each, int wanted, const std::string& what,
                  double reserved = 0);

/// What a factorization may use.
struct FactorResources {
  double memory = 0;  ///< bytes that the process may hold; 0: no bound
  int threads = 1;    ///< fewer where `memory` is short; the bits are the same
};

/// As many threads, at most those of `resources`, as its memory has room for beside the resident
/// memory. `bytes`: what a factorization on so many threads needs.
/// @throws Error(Configuration) when one does not fit.
int threads_that_fit(const FactorResources& resources, const std::function<double(int)>& bytes);

/// Threads that start from now on share as many heaps as there are cores: more sites than cores are
/// in work, taking turns, and a heap of its own would keep what each of them has freed. glibc heeds
/// this while the process has no more than eight heaps.
void share_heaps(int cores);

/// @throws Error(Internal), always: memory ran out in the factorization of so many unknowns.
[[noreturn]] void out_of_memory(int unknowns);

}  // namespace palpate::fem
