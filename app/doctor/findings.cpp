// SPDX-License-Identifier: AGPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "app/doctor/machine.hpp"

namespace palpate::app {
namespace {

constexpr double kGiB = 1024.0 * 1024 * 1024;
constexpr double kLittleMemory = 4 * kGiB;  // less is short for the bodies of data/cases
constexpr double kLittleDisk = 2 * kGiB;
constexpr double kLate = 0.5e-3;  // s: half a period of 1 kHz

Finding finding(bool is_ok, const std::string& what, const std::string& remedy) {
  return {is_ok, is_ok ? what : what + ": " + remedy};
}

/// The kernels that OpenBLAS falls back to where it does not know the processor.
bool is_fallback(std::string kernel) {
  std::transform(kernel.begin(), kernel.end(), kernel.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return kernel == "prescott" || kernel == "generic" || kernel == "core2" || kernel == "armv8";
}

void add_optional(std::vector<Finding>& list, const std::vector<Optional>& parts) {
  for (const Optional& part : parts)
    list.push_back(finding(part.found, fmt::format("{} (optional): {}", part.name, part.purpose),
                           part.remedy));
}

}  // namespace

std::vector<Finding> findings(const Machine& m) {
  std::vector<Finding> list;
  list.push_back(finding(m.processors > 1, fmt::format("processors: {}", m.processors),
                         "a campaign presses one site for each at a time; use more"));
  list.push_back(finding(
      m.available >= kLittleMemory,
      fmt::format("memory: {:.1f} of {:.1f} GiB available", m.available / kGiB, m.memory / kGiB),
      "give --memory to `palpate precompute`, or use a coarser mesh"));
  list.push_back(finding(!is_fallback(m.blas_kernel), "BLAS kernel: " + m.blas_kernel,
                         "slow; set OPENBLAS_CORETYPE to that of the processor (HASWELL, ...)"));
  list.push_back(finding(m.realtime_refusal.empty(),
                         m.realtime_refusal.empty()
                             ? "real-time rights: locked memory and SCHED_FIFO granted"
                             : "real-time rights",
                         m.realtime_refusal));
  list.push_back(finding(m.realtime_kernel, "kernel with PREEMPT_RT",
                         "apt install linux-image-rt-amd64; only a device needs it"));
  list.push_back(finding(m.late_worst < kLate,
                         fmt::format("loop of 1 kHz for half a second: late by {:.0f} us in the "
                                     "median, {:.0f} us at worst; that wakes 400 us early: {:.0f} "
                                     "and {:.0f} us",
                                     1e6 * m.late_median, 1e6 * m.late_worst, 1e6 * m.early_median,
                                     1e6 * m.early_worst),
                         "end other programs; see real-time rights, and --wake-early-us of "
                         "`palpate run`"));
  add_optional(list, m.libraries);
  add_optional(list, m.programs);
  list.push_back(finding(m.free_disk >= kLittleDisk,
                         fmt::format("disk: {:.1f} GiB free in {}", m.free_disk / kGiB, m.folder),
                         "free some space, or choose another folder with --out"));
  return list;
}

}  // namespace palpate::app
