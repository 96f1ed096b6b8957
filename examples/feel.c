/* SPDX-License-Identifier: Apache-2.0 */
/* cc feel.c $(pkg-config --cflags --libs palpate) -o feel && ./feel library.h5 1 0 0
 * A tip goes to the middle of the body from the side that is given, at 0.1 m/s, until it is 3 mm
 * deep. */
#include <palpate.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  palpate_library* library;
  palpate_state* state;
  palpate_settings settings;
  palpate_library_info info = {.size = sizeof info};
  palpate_observation seen = {.size = sizeof seen};
  double force[3], position[3], velocity[3];
  palpate_settings_default(&settings);
  settings.friction = 0.3;
  if (argc < 5 || palpate_library_load(argv[1], &library) ||
      palpate_state_create(library, &settings, &state)) {
    return fprintf(stderr, "feel LIBRARY X Y Z: %s\n", palpate_last_error()), 1;
  }
  palpate_library_describe(library, &info);
  for (int i = 0; i < 5000 && seen.depth < 0.003; ++i) { /* your force loop, 1 kHz */
    for (int k = 0; k < 3; ++k) {
      velocity[k] = -0.1 * atof(argv[2 + k]);
      position[k] = (info.low[k] + info.high[k]) / 2 + (1e-3 * i - 2) * velocity[k];
    }
    palpate_step(state, position, velocity, 1e-3, force);
    palpate_observe(state, &seen);
  }
  printf("(%.4f, %.4f, %.4f) N, %.3f mm deep\n", force[0], force[1], force[2], 1e3 * seen.depth);
  palpate_state_destroy(state);
  palpate_library_destroy(library);
  return 0;
}
