/* SPDX-License-Identifier: Apache-2.0 */
/* palpate: forces of a soft body under a tool, from a response library, at haptic rates.
 *
 *   palpate_library* library;
 *   palpate_state* state;
 *   if (palpate_library_load("library.h5", &library) != PALPATE_OK) puts(palpate_last_error());
 *   palpate_state_create(library, NULL, &state);
 *   for (;;) {
 *     read_device(position, velocity);
 *     palpate_step(state, position, velocity, 1e-3, force);
 *     command_device(force);
 *   }
 *
 * Units are SI: m, m/s, s, N, N/m, J, Hz. Vectors have three components in the frame of the world.
 *
 * Functions that return int return PALPATE_OK or a negative PALPATE_ERROR_*; palpate_last_error()
 * explains the last failure of the calling thread. No exception, signal, output or change of locale
 * crosses this interface.
 *
 * Real time: palpate_step, palpate_observe and palpate_state_set_pose do not allocate, lock or call
 * the system, and their time is bounded. Call all other functions outside the real-time thread.
 *
 * Threads: a library is immutable and may be shared by threads. A state is one tool on one body; it
 * belongs to one thread at a time; palpate_deform alone may read it from others.
 *
 * Structs begin with their size, in bytes. Fields are only ever added at the end: a program
 * compiled with an older header exchanges the fields that it knows. */
#ifndef PALPATE_H
#define PALPATE_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32) && defined(PALPATE_EXPORTS)
#define PALPATE_API __declspec(dllexport)
#elif defined(_WIN32)
#define PALPATE_API
#else
#define PALPATE_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct palpate_library palpate_library;
typedef struct palpate_state palpate_state;
typedef struct palpate_deformation palpate_deformation;

/* Results of calls. */
enum {
  PALPATE_OK = 0,
  PALPATE_ERROR_ARGUMENT = -1, /* a null pointer or a value out of range: see palpate_last_error */
  PALPATE_ERROR_FILE = -2,     /* the file cannot be read: check path and access rights */
  PALPATE_ERROR_FORMAT = -3,   /* not a valid response library: make it again with this version */
  PALPATE_ERROR_MEMORY = -4,   /* out of memory: free memory or load a smaller library */
  /* the loop is not certified passive on the device: a higher rate, a softer library, or set
   * uncertified */
  PALPATE_ERROR_UNCERTIFIED = -5,
  /* the deformation belongs to another library: load the one that was made with this library */
  PALPATE_ERROR_MISMATCH = -6
};

/* Status bits of a step. Bits without "Remedy" belong to normal operation. */
enum {
  /* A local model is active: the tool touches the body. */
  PALPATE_CONTACT = 1u << 0,
  /* The contact began in this step. */
  PALPATE_ACTIVATED = 1u << 1,
  /* The contact ended in this step. */
  PALPATE_RELEASED = 1u << 2,
  /* The contact point moved in this step. */
  PALPATE_SLIDING = 1u << 3,
  /* A slide stopped at a border of the response surface: the contact point stays there and the tool
   * slips over it. Remedy: press farther from the border, or compute responses beyond it. */
  PALPATE_AT_BORDER = 1u << 4,
  /* A slide would have created energy: the depth offset was raised, or the contact point stayed.
   * Remedy, if the force is noticeably softer: a larger tank_cap. */
  PALPATE_ENERGY_LIMITED = 1u << 5,
  /* Deeper than the deepest sample: the curves continue in a straight line. Remedy: compute the
   * library to a larger depth. */
  PALPATE_BEYOND_DEPTH = 1u << 6,
  /* Unusable input: NaN, infinity, dt <= 0, or a tip that moved farther than the diagonal of the
   * body since the last step. The force is zero and the contact is dropped. Remedy: check the
   * device's reading, its units and its frame. */
  PALPATE_BAD_INPUT = 1u << 7,
  /* The contact was dropped and its stored energy discarded: after PALPATE_BAD_INPUT, remedy: leave
   * the body and touch it again; or in a cut-off of the force loop, after which it begins anew
   * where the tip is. */
  PALPATE_DROPPED = 1u << 8,
  /* A slide was rate-limited: the force changes by at most lipschitz_bound times the travel of
   * the tip; later steps make the rest. Remedy, if slides lag noticeably: a larger lipschitz_bound.
   */
  PALPATE_FORCE_LIMITED = 1u << 9,
  /* The contact point waits at an edge for triangles that the search thread has not delivered.
   * Remedy: a higher search_rate. */
  PALPATE_AWAITING = 1u << 10,
  /* The tool is inside the body but above the skin, which has relaxed and not yet recovered: no
   * force. Only where responses relax. */
  PALPATE_SKIN_LAGS = 1u << 11,

  /* Bits of the force loop (palpate_loop_*), also in recordings. */

  /* The force is scaled down: the ramp at the start. The scale rises while no energy is stored. */
  PALPATE_LOOP_RAMPING = 1u << 16,
  /* The force was shortened to max_force. Remedy: press less, or allow more force. */
  PALPATE_LOOP_CLAMPED = 1u << 17,
  /* No force: the tip is faster than max_speed, by the velocity of the device or the difference of
   * its positions. Remedy: move slower; check the device's units. */
  PALPATE_LOOP_TOO_FAST = 1u << 18,
  /* No force: too long since the last step. Remedy: real-time rights (missing_rights of the
   * report), a lower rate, or a processor of its own (core). */
  PALPATE_LOOP_LATE = 1u << 19,
  /* The force was not finite and was replaced by zero. Remedy: report the library as a defect. */
  PALPATE_LOOP_NOT_FINITE = 1u << 20,
  /* The device gave less force than commanded. Remedy: a softer library, or press less. */
  PALPATE_LOOP_SATURATED = 1u << 21,
  /* The device had no new sample; the last one was used again. Remedy: a lower rate of the loop. */
  PALPATE_LOOP_STALE = 1u << 22,
  /* The device is lost and the loop has ended. Remedy: check power and cable, start a new loop. */
  PALPATE_LOOP_DEVICE_LOST = 1u << 23,
  /* The last new sample is older than the watchdog limit: the force falls to zero. Remedy: check
   * the device, its cable and its service. */
  PALPATE_LOOP_OUTDATED = 1u << 24,
  /* The sample is farther from the last than a tip of max_speed can travel: the last one was used
   * again. Remedy: check the device's encoders, cable and units. */
  PALPATE_LOOP_REJECTED = 1u << 25
};

typedef struct palpate_settings {
  uint32_t size; /* sizeof(palpate_settings), set by palpate_settings_default */
  /* mu, friction coefficient; negative (default) = that of the certificate. Above it
   * lipschitz_bound may be exceeded and nothing is certified. */
  double friction;
  double tank_cap; /* J, cap of the energy tank; default 0.005; 0 = no tank (Theorem 2) */
  /* N/m, Lipschitz bound of the force: between two steps the force changes by at most this times
   * the travel of the tip. 0 (default) = lipschitz_bound of the library, or no bound where it has
   * no certificate; any other value must be at least min_lipschitz_bound of the library.
   * palpate_state_certified says whether a device renders this bound passively. */
  double lipschitz_bound;
  /* Hz, rate of a thread that finds the triangles near the tool and delivers them to the step; 100
   * is enough. 0 (default) = no thread: each step searches the whole body. At most 10000. */
  double search_rate;
} palpate_settings;

/* The state after the last step, for recording and display. */
typedef struct palpate_observation {
  uint32_t size;            /* sizeof(palpate_observation), set by the caller */
  uint32_t status;          /* status bits of the last step */
  int32_t element;          /* active element (row of the triangles), -1 without contact */
  double contact_point[3];  /* c, m */
  double natural[3];        /* natural coordinates of c in the active element; they sum to 1 */
  double normal[3];         /* n, unit, into the body */
  double depth;             /* z = n . (x - c) - d0, m */
  double lateral;           /* |x - c - (z + d0) n - s|, m: distance from the anchor; rho of the
                               lateral response without lean, micro-slip and soft axes */
  double offset;            /* d0, depth offset, m */
  double energy;            /* E_i(x), stored in the local model and the memory of the tissue, J */
  double tank;              /* energy tank, J */
  double absorbed;          /* net work of the tool on a body at rest since the state was created or
                               reset, J: the sum over steps of E_{i-1}(x_i) - E_{i-1}(x_{i-1}), x
                               in the body */
  double force_on_body[3];  /* f, N; palpate_step gives -f */
  double lateral_offset[3]; /* s, lateral offset, m: slip that the contact point has not followed,
                               at borders, at edges that await delivery, in rate-limited slides */
  double dissipated; /* energy that relaxation has dissipated since the state was created or reset,
                        J */
  double relaxed_fraction; /* fraction of the instantaneous normal force that has relaxed; 0 where
                      responses are elastic, 1 where the skin lags */
  double relaxed_lateral_force[3]; /* N: what has relaxed of the instantaneous lateral force; the
                                      lateral part of force_on_body is the rest */
} palpate_observation;

typedef struct palpate_library_info {
  uint32_t size; /* sizeof(palpate_library_info), set by the caller */
  int32_t vertices, triangles;
  double stick, slip;         /* L_stick and L_slip, N/m; 0 without a certificate */
  double friction;            /* mu of the certificate */
  double depth;               /* deepest sample, m */
  double low[3], high[3];     /* bounding box in the frame of the body, m */
  double min_lipschitz_bound; /* N/m, smallest enforceable lipschitz_bound; NaN: not known */
  double lipschitz_bound;     /* N/m, enforced by default; infinite without a certificate */
} palpate_library_info;

/* "major.minor.patch". */
PALPATE_API const char* palpate_version(void);
/* One line on the last failure of the calling thread; empty when there was none. */
PALPATE_API const char* palpate_last_error(void);
/* One line on a PALPATE_OK or PALPATE_ERROR_* value. */
PALPATE_API const char* palpate_status_text(int status);

/* Reads and checks a response library: library.h5, or a flat one (library.plib), which is all that
 * a build without HDF5 reads. On failure *library is NULL. */
PALPATE_API int palpate_library_load(const char* path, palpate_library** library);
/* The same from a library file in memory; library.h5 by way of a temporary file in TMPDIR. The
 * bytes are not used after the call. */
PALPATE_API int palpate_library_load_memory(const void* bytes, size_t size,
                                            palpate_library** library);
/* Destroy its states first. NULL is allowed. */
PALPATE_API void palpate_library_destroy(palpate_library* library);
/* Fills the fields that fit into info->size bytes. */
PALPATE_API int palpate_library_describe(const palpate_library* library,
                                         palpate_library_info* info);

/* Geometry of the response surface, in the frame of the body, in the order of the library file.
 * palpate_library_describe gives the numbers of vertices and triangles, and the bounding box.
 * Each function fills an array of the caller, which has room for `capacity` vertices or triangles;
 * PALPATE_ERROR_ARGUMENT, and nothing written, where that is less than there are. Not for the
 * real-time thread; any number of threads at a time. */

/* positions: three coordinates a vertex, m. */
PALPATE_API int palpate_library_vertices(const palpate_library* library, double* positions,
                                         size_t capacity);
/* normals: three components a vertex, the unit press direction u_l, INTO the body: the response
 * f^z acts along it. A mesh that is lit needs the opposite. */
PALPATE_API int palpate_library_normals(const palpate_library* library, double* normals,
                                        size_t capacity);
/* triangles: three vertices a triangle, counted from 0, counter-clockwise seen from outside. Row m
 * is the active element m of an observation. */
PALPATE_API int palpate_library_triangles(const palpate_library* library, int32_t* triangles,
                                          size_t capacity);
/* statuses: where the response of each vertex comes from. Triangles at a hole cannot be touched. */
enum {
  PALPATE_VERTEX_FITTED = 0,       /* from the curves of this vertex */
  PALPATE_VERTEX_INTERPOLATED = 1, /* from its neighbours */
  PALPATE_VERTEX_HOLE = 2          /* no response */
};
PALPATE_API int palpate_library_vertex_statuses(const palpate_library* library, uint8_t* statuses,
                                                size_t capacity);

/* Sets size and every default. */
PALPATE_API void palpate_settings_default(palpate_settings* settings);
/* The library must outlive the state. settings may be NULL: the defaults. On failure *state is
 * NULL. */
PALPATE_API int palpate_state_create(const palpate_library* library,
                                     const palpate_settings* settings, palpate_state** state);
/* NULL is allowed. */
PALPATE_API void palpate_state_destroy(palpate_state* state);
/* Ends the contact and sets all energies to zero. The pose remains. */
PALPATE_API void palpate_state_reset(palpate_state* state);

/* Sets the pose of the body: x_world = rotation x_body + position. rotation: three rows,
 * orthonormal and right-handed. Positions, forces and observations are in the world; until the
 * first call world and body coincide. May be called between steps, also in contact: the body then
 * moves against the tool, and `absorbed` counts that relative motion. The force changes by at
 * most lipschitz_bound times the travel of the tip in the body plus the angle of the turn (rad)
 * times the distance from the tip to the contact point: move the body in small steps. Real-time
 * safe. */
PALPATE_API int palpate_state_set_pose(palpate_state* state, const double position[3],
                                       const double rotation[9]);

/* One step of the force loop. position (m), velocity (m/s): of the tool tip; dt (s): since the last
 * step, > 0, in which tissue that relaxes does so. force (N): of the body on the tool, to command
 * to the device; always finite. Returns status bits. Real-time safe. */
PALPATE_API uint32_t palpate_step(palpate_state* state, const double position[3],
                                  const double velocity[3], double dt, double force[3]);
/* Fills the fields that fit into observation->size bytes. Real-time safe. */
PALPATE_API int palpate_observe(const palpate_state* state, palpate_observation* observation);

/* What decides whether a device renders passively (docs/theory-certificate.md). NaN: unknown. */
typedef struct palpate_device_constants {
  uint32_t size;              /* set by palpate_device_constants_default */
  double damping;             /* N s/m, smallest viscous damping */
  double coulomb_friction;    /* N, smallest dry friction */
  double delay;               /* s, from position to force, beyond one sample of the loop */
  double position_resolution; /* m, step of the reported position along an axis */
  double force_resolution;    /* N, step of the force along an axis */
} palpate_device_constants;

/* Sets size and every constant to NaN. */
PALPATE_API void palpate_device_constants_default(palpate_device_constants* device);
/* Is rendering this state on this device at this rate (Hz) certified passive? 1: it is; 0: it is
 * not, and palpate_last_error says why, with every unknown constant; negative: an error, as for a
 * constant that is negative or infinite. The force ramp and the clamp of a loop, and missed steps,
 * are not covered. Not for the real-time thread. */
PALPATE_API int palpate_state_certified(const palpate_state* state,
                                        const palpate_device_constants* device, double rate);

/* The skin as it is pressed, for a picture: docs/theory-deformation.md has its equations. Its mesh
 * is finer than the response surface. It comes from a file of its own beside the library,
 * deformation.pdef, which needs no HDF5. */

typedef struct palpate_deformation_info {
  uint32_t size; /* sizeof(palpate_deformation_info), set by the caller */
  int32_t vertices, triangles;
  int32_t sites, modes; /* that the displacements are blended from */
  double depth;         /* m, deepest stored displacement; beyond it they go straight on */
  double reach;         /* m, of the part of the displacement that moves with the contact point */
} palpate_deformation_info;

/* Reads and checks the file; the library must outlive the deformation. On failure *deformation is
 * NULL: PALPATE_ERROR_FILE where there is no such file (the case asks for it by depths in
 * [deformation]), PALPATE_ERROR_MISMATCH where it was made with another library. */
PALPATE_API int palpate_deformation_load(const palpate_library* library, const char* path,
                                         palpate_deformation** deformation);
/* The same from a file in memory. The bytes are not used after the call. */
PALPATE_API int palpate_deformation_load_memory(const palpate_library* library, const void* bytes,
                                                size_t size, palpate_deformation** deformation);
/* NULL is allowed. */
PALPATE_API void palpate_deformation_destroy(palpate_deformation* deformation);
/* Fills the fields that fit into info->size bytes. */
PALPATE_API int palpate_deformation_describe(const palpate_deformation* deformation,
                                             palpate_deformation_info* info);
/* As palpate_library_vertices and palpate_library_triangles, for the mesh of the skin. */
PALPATE_API int palpate_deformation_vertices(const palpate_deformation* deformation,
                                             double* positions, size_t capacity);
PALPATE_API int palpate_deformation_triangles(const palpate_deformation* deformation,
                                              int32_t* triangles, size_t capacity);
/* The vertices of the skin in the world, three coordinates each, m, as the last step of the state
 * left them: with the contact point c displaced by n . (x - c) along n and by the lateral
 * deflection across it, and no vertex inside the tool; at rest without contact. positions has room
 * for `capacity` vertices; PALPATE_ERROR_ARGUMENT, and nothing written, where that is less than
 * there are. May be called from any thread beside the one that steps the state, also of a
 * palpate_loop, which it does not delay: for a state this is the exception to the rule that it
 * belongs to one thread. Allocates nothing; its time grows with vertices times modes (about 1 ms
 * for 10,000 vertices and 200 modes): not for the real-time thread. */
PALPATE_API int palpate_deform(const palpate_state* state, const palpate_deformation* deformation,
                               double* positions, size_t capacity);

/* A force loop in a real-time thread of its own, for programs that have none. While it runs the
 * state belongs to it. docs/devices.md, "Safety", describes its safety functions. */

/* How to reach a device. The loop calls read and command from its thread; they must not block for
 * longer than a small part of the period. */
typedef struct palpate_device {
  uint32_t size; /* sizeof(palpate_device), set by the caller */
  void* context; /* first argument of the functions */
  /* position (m) and velocity (m/s) of the tool tip. Returns 0: new sample; 1: no new sample, the
   * last one again; negative: the device is lost. */
  int (*read)(void* context, double position[3], double velocity[3]);
  /* force (N) on the tool. Returns 0: done; 1: saturated; negative: the device is lost. */
  int (*command)(void* context, const double force[3]);
  /* No force from now on. Called from any thread, by the watchdog. May be NULL. */
  void (*halt)(void* context);
  /* N, largest force that the device sustains: the clamp of a loop whose max_force is infinite. 0:
   * not known. */
  double continuous_force;
} palpate_device;

typedef struct palpate_loop_settings {
  uint32_t size;    /* sizeof(palpate_loop_settings), set by palpate_loop_settings_default */
  int32_t priority; /* of SCHED_FIFO, 1 to 99; 0 = ordinary scheduler; default 80 */
  int32_t core;     /* processor of the thread; -1 (default) = any */
  double rate;      /* Hz; default 1000 */
  double ramp; /* s, time in which the force grows to its full value at the start; default 0.5 */
  double max_force; /* N, longer forces are shortened; infinite (default) = continuous_force of the
                       device, where it is known */
  double max_speed; /* m/s, above it there is no force; default 3 */
  double watchdog;  /* s without a step after which the device is halted, and without a new sample
                       after which the force falls to zero; after 50 times as long without a new
                       sample the device is lost; 0 (default) = 20 periods */
  uint32_t record;  /* steps that wait for palpate_loop_take; 0 (default) = none are recorded */
  /* Constants of the device for the certificate, read by palpate_loop_start; NULL (default): not
   * known, and the loop is not certified. */
  const palpate_device_constants* constants;
  uint32_t uncertified; /* 1: start although constants do not certify the rate; default 0 */
  double wake_early; /* s before a step is due at which the thread wakes, to read the clock until it
                        is due: a system wakes a sleeping thread late. 0 (default) to 0.8 periods,
                        which take as much of a processor */
} palpate_loop_settings;

typedef struct palpate_loop_report {
  uint32_t size;         /* sizeof(palpate_loop_report), set by the caller */
  uint32_t lost, halted; /* 1: the device was lost; the watchdog halted it */
  /* Numbers of steps: all; those that ended after the next was due; and those with the bits LATE,
   * LATE or TOO_FAST or OUTDATED, CLAMPED, SATURATED, STALE, NOT_FINITE. */
  uint64_t steps, overruns, late, cut_off, clamped, saturated, stale, not_finite;
  double wake_median, wake_p999, wake_longest;          /* s, delay of the start of a step */
  double compute_median, compute_p999, compute_longest; /* s, duration of a step */
  char missing_rights[256];    /* one line on what the system refused; empty: nothing */
  uint64_t unrecorded;         /* steps for which the record had no room */
  uint64_t outdated, rejected; /* steps with the bits OUTDATED, REJECTED */
  uint32_t silent;    /* 1: the device was lost because it sent no new sample for too long */
  uint32_t certified; /* palpate_loop_certified */
} palpate_loop_report;

/* What a step of the loop read, computed and commanded. */
typedef struct palpate_loop_step {
  uint32_t size;                   /* sizeof(palpate_loop_step), set by the caller */
  uint32_t status;                 /* status bits, with those of the loop */
  int32_t element;                 /* active element, -1 without contact */
  int64_t time_ns;                 /* since the first step */
  int64_t spent_ns;                /* duration, with the calls of the device */
  double position[3], velocity[3]; /* as read from the device, m and m/s */
  double force[3];                 /* commanded, N */
  double contact_point[3];         /* c, m */
  double depth, lateral, offset;   /* z, rho and d0, m */
  double energy, tank, absorbed;   /* J */
} palpate_loop_step;

typedef struct palpate_loop palpate_loop;

/* Sets size and every default. */
PALPATE_API void palpate_loop_settings_default(palpate_loop_settings* settings);
/* Starts the loop. The state and the context of the device must outlive it. settings may be NULL:
 * the defaults. On failure *loop is NULL. PALPATE_ERROR_ARGUMENT where a loop has the state that
 * has not been stopped, PALPATE_ERROR_UNCERTIFIED where the constants of the device do not certify
 * the rate and uncertified is 0: the comparison of `palpate run`. */
PALPATE_API int palpate_loop_start(palpate_state* state, const palpate_device* device,
                                   const palpate_loop_settings* settings, palpate_loop** loop);
/* Is the loop certified passive at its rate, on the device of its constants? 1, or 0 and
 * palpate_last_error says why not; missed steps, the force ramp and the clamp are not covered. */
PALPATE_API int palpate_loop_certified(const palpate_loop* loop);
/* 1 until the loop is stopped or the device is lost, then 0. */
PALPATE_API int palpate_loop_running(const palpate_loop* loop);
/* Takes the oldest recorded step: 1, or 0 when there is none. Call it from one thread at a time. It
 * never delays the loop; when the record is full the loop omits the step and counts it. */
PALPATE_API int palpate_loop_take(palpate_loop* loop, palpate_loop_step* step);
/* Ends the loop after the current step, commands zero force and waits. Recorded steps can still be
 * taken. */
PALPATE_API void palpate_loop_end(palpate_loop* loop);
/* Ends the loop if it still runs, fills the report (may be NULL) and destroys the loop. */
PALPATE_API int palpate_loop_stop(palpate_loop* loop, palpate_loop_report* report);

#ifdef __cplusplus
}
#endif
#endif
