// SPDX-License-Identifier: AGPL-3.0-or-later
// Writes the library that the outside consumer loads: write_plate FILE [FRICTION], with a
// certificate for that friction.
#include <cstdlib>

#include "fitting/certificate/certify.hpp"
#include "tests/support/bodies.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc < 2 || argc > 3) return 2;
  Library plate = test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
  if (argc == 3) fitting::certify(plate, {std::atof(argv[2]), {}});
  write_library(argv[1], plate);
  return 0;
}
