// SPDX-License-Identifier: AGPL-3.0-or-later
// write_bodies FOLDER: libraries whose shape and responses are known in closed form.
#include <filesystem>

#include "fitting/certificate/certify.hpp"
#include "format/flat_library.hpp"
#include "tests/support/bodies.hpp"

namespace {

using namespace palpate;

Library certified(Library library) {
  fitting::DeviceProfile bench;
  bench.name = "bench";
  bench.damping = 2;
  bench.coulomb_friction = 0.1;
  bench.delay = 0;
  bench.position_resolution = 1e-6;
  bench.force_resolution = 1e-3;
  fitting::DeviceProfile unknown;
  unknown.name = "unknown";
  fitting::certify(library, {0.3, {bench, unknown}});
  return library;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  const Library plate =
      test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(170, 120); });
  write_library(folder / "uncertified.h5", plate);
  write_library(folder / "plate.h5", certified(plate));
  write_flat_library(folder / "plate.plib", certified(plate));
  const Library stiffer =
      test::plate(8, 0.08, [](const Vec3&) { return test::wall_response(187, 132); });
  write_library(folder / "stiffer.h5", certified(stiffer));
  const Library ball = test::bumpy_sphere(2, 0.03, 0.05, test::uneven);
  write_library(folder / "ball.h5", certified(ball));
  write_library(folder / "coupled.h5", certified(test::coupled(ball)));
  write_library(folder / "leaning.h5", certified(test::leaning(test::coupled(ball), 0.2)));
  write_library(folder / "soft.h5",
                certified(test::soft_axes(test::leaning(test::coupled(ball), 0.15), 0.4)));
  write_library(folder / "relaxing.h5", certified(test::relaxing(ball, {0.02, 0.5}, false)));
  Library hole = plate;
  hole.responses[0] = {};
  write_library(folder / "hole.h5", certified(hole));
  return 0;
}
