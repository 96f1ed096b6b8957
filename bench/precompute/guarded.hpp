// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <cstdio>
#include <exception>

namespace palpate {

/// The exit status of a benchmark: 0, or 1 after the message of an error, of a file for example.
template <class Benchmark>
int guarded(const Benchmark& benchmark) {
  try {
    benchmark();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace palpate
