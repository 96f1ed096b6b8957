// SPDX-License-Identifier: AGPL-3.0-or-later
// What this machine offers to palpate.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace palpate::app {

/// A program or library and what it is for.
struct Optional {
  std::string name;     ///< of the program, or of the owner of the library
  std::string purpose;  ///< "draws ...": what is missing without it
  std::string remedy;
  bool found = false;
};

struct Machine {
  int processors = 0;                ///< that this process may use
  double memory = 0, available = 0;  ///< bytes, of the machine and free
  std::string blas_kernel;
  std::string realtime_refusal;              ///< what become_realtime was refused; empty: nothing
  bool realtime_kernel = false;              ///< PREEMPT_RT
  double late_median = 0, late_worst = 0;    ///< s, of the steps of a short loop of 1 kHz
  double early_median = 0, early_worst = 0;  ///< s, of one that wakes 0.4 ms early
  std::vector<Optional> libraries, programs;
  std::string folder;    ///< in which the artifacts would be
  double free_disk = 0;  ///< bytes there
};

/// Looks at the machine; takes a second for two loops.
/// @param blas_kernel  that of fem::blas_kernel()
Machine look_at_machine(const std::string& blas_kernel);

/// One line of `palpate doctor`.
struct Finding {
  bool is_ok = true;
  std::string text;  ///< what was found and, where something is missing, the remedy
};

/// One finding for each subject, in a fixed order.
std::vector<Finding> findings(const Machine& machine);

}  // namespace palpate::app
