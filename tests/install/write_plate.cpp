// SPDX-License-Identifier: AGPL-3.0-or-later
// Writes the library that the outside consumer loads: write_plate FILE [FRICTION], with a
// certificate for that friction; a flat one where the name ends in .plib.
#include <cstdlib>
#include <filesystem>

#include "fitting/certificate/certify.hpp"
#include "format/flat_library.hpp"
#include "tests/support/bodies.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc < 2 || argc > 3) return 2;
  Library plate = test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
  if (argc == 3) fitting::certify(plate, {std::atof(argv[2]), {}});
  const std::filesystem::path file = argv[1];
  file.extension() == ".plib" ? write_flat_library(file, plate) : write_library(file, plate);
  return 0;
}
