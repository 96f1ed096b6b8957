// SPDX-License-Identifier: AGPL-3.0-or-later
#include "fem/factor/memory.hpp"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "format/error.hpp"

namespace palpate::fem {

namespace {

std::string megabytes(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f MB", 1e-6 * bytes);
  return text;
}

}  // namespace

double resident_bytes() {
  std::ifstream statistics("/proc/self/statm");
  double total = 0, resident = 0;
  statistics >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

double machine_bytes() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

int fitting_times(double bound, double each, int wanted, const std::string& what, double reserved) {
  if (bound <= 0) return wanted;
  const double used = resident_bytes();
  const double times = std::max(0.0, bound - used - reserved) / each;
  if (times >= 1) return times >= wanted ? wanted : static_cast<int>(times);
  throw Error(ErrorKind::Configuration, "memory of " + megabytes(bound),
              what + " needs " + megabytes(each) + " beside the " + megabytes(used) + " in use" +
                  (reserved > 0 ? " and " + megabytes(reserved) + " reserved" : ""),
              "allow more memory, use fewer threads or a coarser mesh");
}

int threads_that_fit(const FactorResources& resources, const std::function<double(int)>& bytes) {
  int threads = std::max(1, resources.threads);
  while (resources.memory > 0 && threads > 1 &&
         resident_bytes() + bytes(threads) > resources.memory)
    --threads;
  fitting_times(resources.memory, bytes(threads), 1, "the factor of the stiffness");
  return threads;
}

void share_heaps(int cores) {
  mallopt(M_ARENA_MAX, std::max(1, cores));
}

void out_of_memory(int unknowns) {
  throw Error(ErrorKind::Internal, "stiffness factorization",
              "not enough memory for " + std::to_string(unknowns) + " unknowns",
              "use a coarser mesh, fewer threads, or a machine with more memory");
}

}  // namespace palpate::fem
