/* SPDX-License-Identifier: Apache-2.0 */
/* The public C interface of the palpate runtime: load a response library, step a tool over it.
 *
 * Units are SI (m, m/s, s, N, J). Functions return PALPATE_OK or a negative status; the text of the
 * last failure of the calling thread is palpate_last_error(). No exception, signal, thread, output
 * or locale change crosses this interface. Loading, creating and destroying belong outside the
 * real-time thread; palpate_step never allocates, locks, or calls the system. A library is
 * immutable and may be shared by threads, each with states of its own, one for each tool; a state
 * belongs to one thread at a time. Structs begin with their size: fields are only ever added at the
 * end, and a program built with an older header gets and gives the fields that it knows. */
#ifndef PALPATE_H
#define PALPATE_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define PALPATE_API
#else
#define PALPATE_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct palpate_library palpate_library;
typedef struct palpate_state palpate_state;

/* Status of calls. */
enum {
  PALPATE_OK = 0,
  PALPATE_ERROR_ARGUMENT = -1, /* a null pointer or a value out of range: see the message */
  PALPATE_ERROR_FILE = -2,     /* the file cannot be read: check path and rights */
  PALPATE_ERROR_FORMAT = -3,   /* not a valid response library: rebuild it with this version */
  PALPATE_ERROR_MEMORY = -4    /* out of memory */
};

/* Bits of the status of a step. From 1 << 16 on: of a step of the force loop (recordings). */
enum {
  PALPATE_CONTACT = 1u << 0,        /* a local model is active */
  PALPATE_ACTIVATED = 1u << 1,      /* a collision was accepted in this step */
  PALPATE_RELEASED = 1u << 2,       /* the contact ended in this step */
  PALPATE_SLIDING = 1u << 3,        /* the contact point moved in this step */
  PALPATE_AT_BORDER = 1u << 4,      /* the slide stopped at a border of the response surface */
  PALPATE_ENERGY_LIMITED = 1u << 5, /* the energy rule changed d0 or held the contact point */
  PALPATE_BEYOND_DEPTH = 1u << 6,   /* deeper than the deepest sample: linear continuation */
  PALPATE_BAD_INPUT = 1u << 7,      /* NaN, infinity, dt <= 0, or a step longer than the diagonal of
                                       the body: zero force, the contact is dropped */
  PALPATE_DROPPED = 1u << 8,        /* the contact was dropped, what it stored discarded */
  PALPATE_FORCE_LIMITED =
      1u << 9,                      /* a slide or a return of d0 was made in part only, so that the
                                       force changes by no more than lipschitz_bound times the travel */
  PALPATE_AWAITING = 1u << 10,      /* the contact point waits at an edge for triangles that the
                                       search thread has not delivered yet */
  PALPATE_LOOP_RAMPING = 1u << 16,  /* the force is scaled while it is let in */
  PALPATE_LOOP_CLAMPED = 1u << 17,  /* shortened to the largest allowed force */
  PALPATE_LOOP_TOO_FAST = 1u << 18, /* cut off: faster than allowed */
  PALPATE_LOOP_LATE = 1u << 19,     /* cut off: too long since the step before */
  PALPATE_LOOP_NOT_FINITE = 1u << 20, /* the force was no number: zero */
  PALPATE_LOOP_SATURATED = 1u << 21,  /* the device gave less than it was asked for */
  PALPATE_LOOP_STALE = 1u << 22,      /* the device had no new sample */
  PALPATE_LOOP_DEVICE_LOST = 1u << 23 /* the device went away: the loop ended */
};

typedef struct palpate_settings {
  uint32_t size;          /* sizeof(palpate_settings), set by palpate_settings_default */
  double friction;        /* mu; negative = the value the library was certified for */
  double tank_cap;        /* J, cap of the energy tank; 0 = strict Theorem 2 */
  double lipschitz_bound; /* N/m: the force changes by at most this times the travel of the tip; 0 =
                       the limit of the certificate; else at least its L_hold. On a device of
                       smallest damping b at the period T, b/(2 T) is certified passive. Without a
                       certificate there is no limit but the one given here. */
  double search_rate; /* Hz: a thread of its own looks for the triangles near the tool at this rate
                         (100 is plenty) and hands them to the step; 0 = no thread, the step
                         searches the whole body */
} palpate_settings;

/* Everything a recorder or a picture wants to know of the last step. */
typedef struct palpate_observation {
  uint32_t size;            /* sizeof(palpate_observation), set by the caller */
  uint32_t status;          /* bits of the last step */
  int32_t element;          /* active triangle, -1 without contact */
  double contact_point[3];  /* c, m */
  double natural[3];        /* natural coordinates of c in the element */
  double normal[3];         /* n, unit, into the body */
  double depth;             /* z = delta^z, m */
  double lateral;           /* rho = |x - c - (z + d0) n - s|, m */
  double offset;            /* d0, m */
  double energy;            /* E_i(x), J */
  double tank;              /* J */
  double absorbed;          /* net work done by the tool on the body since creation, J: the exact
                               sum over steps of E_{i-1}(x_i) - E_{i-1}(x_{i-1}) */
  double force_on_body[3];  /* f, N; the device is commanded -f */
  double lateral_offset[3]; /* s, m: how far friction has let go of the tool where c could not
                               follow: at borders, at edges not yet delivered, and while a slide is
                               held back */
} palpate_observation;

typedef struct palpate_library_info {
  uint32_t size; /* sizeof(palpate_library_info), set by the caller */
  int32_t vertices, triangles;
  double stick, slip;     /* certified bounds, N/m; 0 when the library has no certificate */
  double friction;        /* mu of the certificate */
  double depth;           /* deepest sample, m */
  double low[3], high[3]; /* bounding box, m */
  double hold;            /* N/m, the least lipschitz_bound that a state can keep; NaN: not known */
  double limit;           /* N/m, the lipschitz_bound that a state keeps unless it is given one */
} palpate_library_info;

PALPATE_API const char* palpate_version(void);
PALPATE_API const char* palpate_last_error(void);
PALPATE_API const char* palpate_status_text(int status);

PALPATE_API int palpate_library_load(const char* path, palpate_library** library);
/* The same from a library file in memory, by way of a temporary file; the bytes may go away
 * afterwards. */
PALPATE_API int palpate_library_load_memory(const void* bytes, size_t size,
                                            palpate_library** library);
PALPATE_API void palpate_library_destroy(palpate_library* library);
PALPATE_API int palpate_library_describe(const palpate_library* library,
                                         palpate_library_info* info);

PALPATE_API void palpate_settings_default(palpate_settings* settings);
/* The library must outlive the state. settings may be NULL for the defaults. */
PALPATE_API int palpate_state_create(const palpate_library* library,
                                     const palpate_settings* settings, palpate_state** state);
PALPATE_API void palpate_state_destroy(palpate_state* state);
PALPATE_API void palpate_state_reset(palpate_state* state);

/* Where the body is: x_world = rotation x_body + position, rotation by rows and rigid. Positions,
 * forces and observations are in the world; at first the two are the same. May be called between
 * steps, also in contact: the body then moves against the tool, and `absorbed` counts their
 * relative motion, so that who moves the body takes part in the work. Real-time safe. */
PALPATE_API int palpate_state_set_pose(palpate_state* state, const double position[3],
                                       const double rotation[9]);

/* One step of the force loop. position, velocity: of the tool tip; dt: since the last step, > 0.
 * force: what to command to the device, the force of the body on the tool (-f). Always finite.
 * Returns status bits. Real-time safe. */
PALPATE_API uint32_t palpate_step(palpate_state* state, const double position[3],
                                  const double velocity[3], double dt, double force[3]);
PALPATE_API int palpate_observe(const palpate_state* state, palpate_observation* observation);

/* A force loop in a real-time thread of its own, for programs that have none. While it runs the
 * state belongs to it. Everything in docs/devices.md under "Safety" holds for it. */

/* How to reach a device. Called from the loop; must not block for long. */
typedef struct palpate_device {
  uint32_t size; /* sizeof(palpate_device) */
  void* context; /* handed to the functions */
  /* 0: done; 1: no new sample, the last one again; negative: the device is lost. */
  int (*read)(void* context, double position[3], double velocity[3]);
  /* 0: done; 1: saturated; negative: the device is lost. force: on the tool, N. */
  int (*command)(void* context, const double force[3]);
  void (*halt)(void* context); /* no force from now on; from any thread; may be NULL */
} palpate_device;

typedef struct palpate_loop_settings {
  uint32_t size;    /* sizeof(palpate_loop_settings), set by palpate_loop_settings_default */
  int32_t priority; /* of SCHED_FIFO, 1 to 99; 0 = the ordinary scheduler; default 80 */
  int32_t core;     /* processor to stay on; -1 = any */
  double rate;      /* Hz; default 1000 */
  double ramp;      /* s, from no force to full force; default 0.5 */
  double max_force; /* N; default: no clamp */
  double max_speed; /* m/s, beyond it the force is cut off; default 3 */
  double watchdog;  /* s without a step after which the device is halted; default 0.02 */
  uint32_t record;  /* steps that are kept until palpate_loop_take; default 0: none are */
} palpate_loop_settings;

typedef struct palpate_loop_report {
  uint32_t size;         /* sizeof(palpate_loop_report), set by the caller */
  uint32_t lost, halted; /* 1: the device went away; the watchdog halted it */
  uint64_t steps, overruns, late, cut_off, clamped, saturated, stale, not_finite;
  double wake_median, wake_p999, wake_longest;          /* s late for a step */
  double compute_median, compute_p999, compute_longest; /* s for a step with the device's calls */
  char missing_rights[256]; /* one line on what the system refused; empty: nothing */
  uint64_t unrecorded;      /* steps for which the record had no room */
} palpate_loop_report;

/* What a step of the loop read, felt and commanded. */
typedef struct palpate_loop_step {
  uint32_t size;                   /* sizeof(palpate_loop_step), set by the caller */
  uint32_t status;                 /* status bits, those of the loop included */
  int32_t element;                 /* active triangle, -1 without contact */
  int64_t time_ns;                 /* since the first step */
  int64_t spent_ns;                /* by the step, the calls of the device included */
  double position[3], velocity[3]; /* as the device told them */
  double force[3];                 /* commanded, N */
  double contact_point[3];         /* m */
  double depth, lateral, offset;   /* m */
  double energy, tank, absorbed;   /* J, the energy account */
} palpate_loop_step;

typedef struct palpate_loop palpate_loop;

PALPATE_API void palpate_loop_settings_default(palpate_loop_settings* settings);
/* Starts at once. The state and what the device needs must outlive the loop. settings may be NULL.
 */
PALPATE_API int palpate_loop_start(palpate_state* state, const palpate_device* device,
                                   const palpate_loop_settings* settings, palpate_loop** loop);
/* 1 until it has been stopped or the device is lost. */
PALPATE_API int palpate_loop_running(const palpate_loop* loop);
/* The oldest step that was recorded and not yet taken: 1, or 0 when there is none now. From one
 * thread at a time, which never holds up the loop; a loop that finds no room leaves a step out and
 * counts it. */
PALPATE_API int palpate_loop_take(palpate_loop* loop, palpate_loop_step* step);
/* Ends the loop after the step under way, commands no force and waits. What was recorded can still
 * be taken. */
PALPATE_API void palpate_loop_end(palpate_loop* loop);
/* Ends the loop if that was not done, reports (report may be NULL) and frees the loop. */
PALPATE_API int palpate_loop_stop(palpate_loop* loop, palpate_loop_report* report);

#ifdef __cplusplus
}
#endif
#endif
