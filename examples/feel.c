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
  palpate_library_info box = {.size = sizeof box};
  palpate_observation seen = {.size = sizeof seen};
  double at[3], v[3], force[3];
  if (argc < 5 || palpate_library_load(argv[1], &library) ||
      palpate_state_create(library, NULL, &state))
    return fprintf(stderr, "feel: %s\n", argc < 5 ? "give LIBRARY X Y Z" : palpate_last_error()), 1;
  palpate_library_describe(library, &box);
  for (int k = 0; k < 3; ++k) v[k] = -0.1 * atof(argv[2 + k]);
  for (int i = -2000; i < 2000 && seen.depth < 0.003; ++i) { /* your force loop, 1 kHz */
    for (int k = 0; k < 3; ++k) at[k] = (box.low[k] + box.high[k]) / 2 + 1e-3 * i * v[k];
    palpate_step(state, at, v, 1e-3, force);
    palpate_observe(state, &seen);
  }
  printf("(%.4f, %.4f, %.4f) N, %.3f mm deep\n", force[0], force[1], force[2], 1e3 * seen.depth);
  palpate_state_destroy(state);
  palpate_library_destroy(library);
}
