/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Loads a plate, presses it by 4 mm and compares the force with the law the library was made with:
 * f = 100 k d^2, k = 170 N/m. Plain C99, nothing but the installed header. */
#include <math.h>
#include <palpate.h>
#include <stdio.h>

static int complain(const char* what) {
  fprintf(stderr, "consumer: %s (%s)\n", what, palpate_last_error());
  return 1;
}

int main(int argc, char** argv) {
  palpate_library* library = NULL;
  palpate_state* state = NULL;
  palpate_library_info info;
  palpate_settings settings;
  palpate_observation seen;
  const double velocity[3] = {0, 0, 0};
  double force[3] = {0, 0, 0};
  double expected, z;
  int i;

  if (argc != 2) return complain("usage: consumer LIBRARY");
  if (palpate_library_load("/nonexistent/library.h5", &library) != PALPATE_ERROR_FILE) {
    return complain("a missing file was not reported as such");
  }
  if (palpate_library_load(argv[1], &library) != PALPATE_OK) return complain("cannot load");
  info.size = sizeof info;
  if (palpate_library_describe(library, &info) != PALPATE_OK || info.triangles <= 0) {
    return complain("cannot describe");
  }
  palpate_settings_default(&settings);
  settings.friction = 0.3;
  if (palpate_state_create(library, &settings, &state) != PALPATE_OK) return complain("no state");

  for (i = -1; i <= 40; ++i) {
    const double position[3] = {0.031, 0.042, -1e-4 * i};
    palpate_step(state, position, velocity, 1e-3, force);
  }
  seen.size = sizeof seen;
  if (palpate_observe(state, &seen) != PALPATE_OK) return complain("cannot observe");
  z = 0.004 - seen.offset;
  expected = 100 * 170 * z * z;
  printf("palpate %s: %.6f N at %.2f mm\n", palpate_version(), force[2], 1e3 * z);
  if (!(seen.status & PALPATE_CONTACT)) return complain("no contact");
  if (fabs(force[2] - expected) > 1e-6 || fabs(force[0]) > 1e-9) return complain("wrong force");
  palpate_state_destroy(state);
  palpate_library_destroy(library);
  return 0;
}
