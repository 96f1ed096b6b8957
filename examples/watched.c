/* SPDX-License-Identifier: Apache-2.0 */
/* cc watched.c $(pkg-config --cflags --libs palpate) -lm -o watched
 * ./watched library.plib 0 0 1 20 | palpate watch library.plib --stdin
 * A force loop of 20 s on a device that goes in and out of the middle of the body from the side
 * that is given. The main thread prints the recorded steps, which palpate watch shows: a reader
 * that is too slow loses steps and never delays the loop. */
#include <inttypes.h>
#include <math.h>
#include <palpate.h>
#include <stdio.h>
#include <stdlib.h>
#include <threads.h>

typedef struct hand {
  double top[3], in[3]; /* where the surface is met, and the direction into the body */
  int64_t step;
} hand;

/* 5 mm above the surface to 3 mm below it and back, in 4 s. */
static int read_hand(void* context, double position[3], double velocity[3]) {
  hand* h = context;
  const double t = 1e-3 * (double)h->step++, turn = 1.5707963267948966 * t;
  for (int k = 0; k < 3; ++k) {
    position[k] = h->top[k] - h->in[k] * (0.001 + 0.004 * cos(turn));
    velocity[k] = h->in[k] * 0.004 * 1.5707963267948966 * sin(turn);
  }
  return 0;
}

static int take_force(void* context, const double force[3]) {
  (void)context, (void)force;
  return 0;
}

/* Goes to the middle from the side, until the tip touches the body. */
static void find_surface(palpate_state* state, const palpate_library_info* box, const char** side,
                         hand* h) {
  double at[3], force[3], length = 0;
  const double still[3] = {0, 0, 0};
  for (int k = 0; k < 3; ++k) length += atof(side[k]) * atof(side[k]);
  for (int k = 0; k < 3; ++k) h->in[k] = -atof(side[k]) / sqrt(length);
  for (int i = -2000; i < 0; ++i) {
    for (int k = 0; k < 3; ++k) at[k] = (box->low[k] + box->high[k]) / 2 + 1e-4 * i * h->in[k];
    if (palpate_step(state, at, still, 1e-3, force) & PALPATE_CONTACT) break;
  }
  for (int k = 0; k < 3; ++k) h->top[k] = at[k];
  palpate_state_reset(state);
}

static void print_three(const double v[3]) {
  printf("%.17g,%.17g,%.17g,", v[0], v[1], v[2]);
}

static void print_step(const palpate_loop_step* s) {
  printf("%" PRId64 ",", s->time_ns);
  print_three(s->position);
  print_three(s->velocity);
  print_three(s->force);
  print_three(s->contact_point);
  printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%" PRId32 ",%" PRIu32 ",%" PRId64 "\n", s->depth,
         s->lateral, s->offset, s->energy, s->tank, s->absorbed, s->element, s->status,
         s->spent_ns);
}

/* Prints the steps until there are so many. */
static void print_steps(palpate_loop* loop, long count) {
  palpate_loop_step step = {.size = sizeof step};
  printf(
      "time_ns,position_x_m,position_y_m,position_z_m,velocity_x_m_s,velocity_y_m_s,velocity_z_m_s,"
      "force_x_N,force_y_N,"
      "force_z_N,contact_x_m,contact_y_m,contact_z_m,depth_m,lateral_m,offset_m,energy_J,tank_J,"
      "absorbed_J,element,status,"
      "latency_ns\n");
  while (count > 0 && palpate_loop_running(loop)) {
    for (; count > 0 && palpate_loop_take(loop, &step); --count) print_step(&step);
    fflush(stdout);
    thrd_sleep(&(struct timespec){.tv_nsec = 10000000}, NULL);
  }
}

int main(int argc, char** argv) {
  palpate_library* library;
  palpate_state* state;
  palpate_loop* loop;
  palpate_library_info box = {.size = sizeof box};
  palpate_loop_settings settings;
  palpate_loop_report report = {.size = sizeof report};
  hand h = {.step = 0};
  palpate_device device = {
      .size = sizeof device, .context = &h, .read = read_hand, .command = take_force};
  if (argc < 6 || palpate_library_load(argv[1], &library) ||
      palpate_state_create(library, NULL, &state))
    return fprintf(stderr, "watched: %s\n",
                   argc < 6 ? "give LIBRARY X Y Z SECONDS" : palpate_last_error()),
           1;
  palpate_library_describe(library, &box);
  find_surface(state, &box, (const char**)argv + 2, &h);
  palpate_loop_settings_default(&settings);
  settings.max_force = 5;
  settings.record = 1 << 15;
  if (palpate_loop_start(state, &device, &settings, &loop))
    return fprintf(stderr, "watched: %s\n", palpate_last_error()), 1;
  print_steps(loop, (long)(1000 * atof(argv[5])));
  palpate_loop_stop(loop, &report);
  fprintf(stderr, "watched: %" PRIu64 " steps, %" PRIu64 " not recorded\n", report.steps,
          report.unrecorded);
  palpate_state_destroy(state);
  palpate_library_destroy(library);
}
