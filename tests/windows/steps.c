/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* steps LIBRARY: presses a body from six sides, slides, and prints the bits of each force and
 * state, so that the runtimes of two systems can be compared. steps LIBRARY loop: runs the force
 * loop for half a second at 1 kHz beside a device that does not move, and prints how many steps it
 * made and how late. */
#include <inttypes.h>
#include <palpate.h>
#include <stdio.h>
#include <string.h>
#if defined(_WIN32)
#include <windows.h>
static void rest(void) {
  Sleep(500);
}
#else
#include <time.h>
static void rest(void) {
  const struct timespec half = {0, 500000000};
  nanosleep(&half, NULL);
}
#endif

static int complain(const char* what) {
  fprintf(stderr, "steps: %s (%s)\n", what, palpate_last_error());
  return 1;
}

static void print_bits(const double* numbers, int count) {
  for (int i = 0; i < count; ++i) {
    uint64_t bits;
    memcpy(&bits, numbers + i, sizeof bits);
    printf("%016" PRIx64 " ", bits);
  }
}

static void press_from(palpate_state* state, const palpate_library_info* info, int side) {
  const int axis = side / 2;
  const double sign = side % 2 ? -1 : 1;
  const double still[3] = {0, 0, 0};
  palpate_state_reset(state);
  for (int i = 0; i < 600; ++i) {
    double position[3], force[3];
    palpate_observation seen = {.size = sizeof seen};
    for (int k = 0; k < 3; ++k) position[k] = 0.5 * (info->low[k] + info->high[k]);
    /* Outside by a tenth of the body, 1 mm a step; then sideways. */
    const double reach = 0.6 * (info->high[axis] - info->low[axis]);
    const double depth = 1e-3 * (i < 400 ? i : 400);
    position[axis] += sign * (reach - (depth < reach ? depth : reach));
    position[(axis + 1) % 3] += i < 400 ? 0 : 2e-5 * (i - 400);
    const uint32_t status = palpate_step(state, position, still, 1e-3, force);
    palpate_observe(state, &seen);
    if (seen.element < 0) continue;
    printf("%d %d %08" PRIx32 " %d ", side, i, status, (int)seen.element);
    print_bits(force, 3);
    print_bits(&seen.depth, 1);
    print_bits(&seen.energy, 1);
    print_bits(&seen.tank, 1);
    printf("\n");
  }
}

static int read_still(void* context, double position[3], double velocity[3]) {
  memcpy(position, context, 3 * sizeof *position);
  velocity[0] = velocity[1] = velocity[2] = 0;
  return 0;
}

static int command_nothing(void* context, const double force[3]) {
  (void)context;
  (void)force;
  return 0;
}

static int run_loop(palpate_state* state, const palpate_library_info* info) {
  double high[3] = {info->high[0], info->high[1], info->high[2]};
  palpate_device device = {
      .size = sizeof device, .context = high, .read = read_still, .command = command_nothing};
  palpate_loop_settings settings;
  palpate_loop_report report = {.size = sizeof report};
  palpate_loop* loop = NULL;
  palpate_loop_settings_default(&settings);
  settings.max_force = 1;
  settings.watchdog = 0.5;
  if (palpate_loop_start(state, &device, &settings, &loop) != PALPATE_OK)
    return complain("no loop");
  rest();
  if (!palpate_loop_running(loop)) return complain("the loop ended by itself");
  palpate_loop_stop(loop, &report);
  printf("%d steps, median %d us late\n", (int)report.steps, (int)(1e6 * report.wake_median));
  return 0;
}

int main(int argc, char** argv) {
  palpate_library* library = NULL;
  palpate_state* state = NULL;
  palpate_library_info info = {.size = sizeof info};
  int failed = 0;
  if (argc < 2) return complain("usage: steps LIBRARY [loop]");
  if (palpate_library_load(argv[1], &library) != PALPATE_OK) return complain("cannot load");
  if (palpate_library_describe(library, &info) != PALPATE_OK) return complain("cannot describe");
  if (palpate_state_create(library, NULL, &state) != PALPATE_OK) return complain("no state");
  if (argc > 2)
    failed = run_loop(state, &info);
  else
    for (int side = 0; side < 6; ++side) press_from(state, &info, side);
  palpate_state_destroy(state);
  palpate_library_destroy(library);
  return failed;
}
