// SPDX-License-Identifier: AGPL-3.0-or-later
// write_engine_bodies FOLDER: plate.plib, f = 17000 z^2 along the normal of the plate z = 0, and
// plate.pdef, a skin that dents under the tool.
#include <filesystem>

#include "fitting/certificate/certify.hpp"
#include "format/deformation.hpp"
#include "format/flat_library.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/dimpled_skin.hpp"

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  Library plate = test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
  fitting::certify(plate, {0.3, {}});
  write_flat_library(folder / "plate.plib", plate);
  write_deformation(folder / "plate.pdef",
                    test::dimpled(plate, test::skin_of(plate), 0.006, plate.tool_radius));
  return 0;
}
