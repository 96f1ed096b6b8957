// SPDX-License-Identifier: AGPL-3.0-or-later
// Writes the library that the outside consumer loads.
#include "bodies.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc != 2) return 2;
  write_library(argv[1],
                test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); }));
  return 0;
}
