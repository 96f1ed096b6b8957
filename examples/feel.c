/* SPDX-License-Identifier: Apache-2.0 */
/* cc feel.c $(pkg-config --cflags --libs palpate) */
#include <palpate.h>
#include <stdio.h>

int main(int argc, char** argv) {
  palpate_library* library;
  palpate_state* state;
  palpate_settings settings;
  double force[3], velocity[3] = {0, 0, -0.1};
  palpate_settings_default(&settings);
  settings.friction = 0.3;
  if (argc < 2 || palpate_library_load(argv[1], &library) ||
      palpate_state_create(library, &settings, &state)) {
    return fprintf(stderr, "%s\n", palpate_last_error()), 1;
  }
  for (int i = 0; i < 40; ++i) { /* your force loop */
    const double position[3] = {0.031, 0.042, 0.0005 - 1e-4 * i};
    palpate_step(state, position, velocity, 1e-3, force);
  }
  printf("%.4f N at %.1f mm\n", force[2], 3.4);
  palpate_state_destroy(state);
  palpate_library_destroy(library);
  return 0;
}
