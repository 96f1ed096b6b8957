// SPDX-License-Identifier: AGPL-3.0-or-later
// touch_forces: reads positions of a tip, m, three numbers a line, and writes the forces on the
// tool that the C interface gives for them on the library of full.html, one step of 1 ms each.
#include <cstdio>
#include <iostream>

#include "format/flat_library.hpp"
#include "runtime/palpate.h"
#include "tests/unit/app/report/synthetic.hpp"

int main() {
  const std::string bytes = palpate::flat_bytes(palpate::testing::synthetic(3, 2).library, "lump");
  palpate_library* library = nullptr;
  palpate_state* state = nullptr;
  if (palpate_library_load_memory(bytes.data(), bytes.size(), &library) != PALPATE_OK ||
      palpate_state_create(library, nullptr, &state) != PALPATE_OK) {
    std::cerr << palpate_last_error() << '\n';
    return 1;
  }
  double x[3], force[3];
  const double still[3] = {};
  while (std::cin >> x[0] >> x[1] >> x[2]) {
    palpate_step(state, x, still, 1e-3, force);
    std::printf("%.17g %.17g %.17g\n", force[0], force[1], force[2]);
  }
  palpate_state_destroy(state);
  palpate_library_destroy(library);
  return 0;
}
