// SPDX-License-Identifier: Apache-2.0
// The C interface: checks arguments and turns exceptions into statuses.
#include "runtime/palpate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "format/error.hpp"
#include "format/guarantee.hpp"
#include "format/regular_file.hpp"
#include "palpate_version.hpp"
#include "runtime/c_boundary.hpp"
#include "runtime/certified_state.hpp"
#include "runtime/handles.hpp"
#include "runtime/status.hpp"

using palpate::Vec3;
using palpate::runtime::copy;
using palpate::operator-;
using palpate::runtime::ContactObservation;
using palpate::runtime::ContactSettings;
using palpate::runtime::fail;
using palpate::runtime::give;
using palpate::runtime::give_array;
using palpate::runtime::guarded;

namespace {

// The bits of the C interface are those of the runtime.
namespace bits = palpate::runtime::step_status;
static_assert(PALPATE_CONTACT == std::uint32_t{bits::Contact});
static_assert(PALPATE_ACTIVATED == std::uint32_t{bits::Activated});
static_assert(PALPATE_RELEASED == std::uint32_t{bits::Released});
static_assert(PALPATE_SLIDING == std::uint32_t{bits::Sliding});
static_assert(PALPATE_AT_BORDER == std::uint32_t{bits::AtBorder});
static_assert(PALPATE_ENERGY_LIMITED == std::uint32_t{bits::EnergyLimited});
static_assert(PALPATE_BEYOND_DEPTH == std::uint32_t{bits::BeyondDepth});
static_assert(PALPATE_BAD_INPUT == std::uint32_t{bits::BadInput});
static_assert(PALPATE_DROPPED == std::uint32_t{bits::Dropped});
static_assert(PALPATE_FORCE_LIMITED == std::uint32_t{bits::ForceLimited});
static_assert(PALPATE_AWAITING == std::uint32_t{bits::Awaiting});
static_assert(PALPATE_LOOP_RAMPING == std::uint32_t{bits::LoopRamping});
static_assert(PALPATE_LOOP_CLAMPED == std::uint32_t{bits::LoopClamped});
static_assert(PALPATE_LOOP_TOO_FAST == std::uint32_t{bits::LoopTooFast});
static_assert(PALPATE_LOOP_LATE == std::uint32_t{bits::LoopLate});
static_assert(PALPATE_LOOP_NOT_FINITE == std::uint32_t{bits::LoopNotFinite});
static_assert(PALPATE_LOOP_SATURATED == std::uint32_t{bits::LoopSaturated});
static_assert(PALPATE_LOOP_STALE == std::uint32_t{bits::LoopStale});
static_assert(PALPATE_LOOP_DEVICE_LOST == std::uint32_t{bits::LoopDeviceLost});
static_assert(PALPATE_LOOP_OUTDATED == std::uint32_t{bits::LoopOutdated});
static_assert(PALPATE_LOOP_REJECTED == std::uint32_t{bits::LoopRejected});

constexpr double kDefaultTankCap = 5e-3;   // J
constexpr double kMostSearchRate = 10000;  // Hz

thread_local char last_error[512] = "";

// Smallest valid sizes of the structs: a smaller size is an error, one in between is that of an
// older header, a larger one that of a newer header.
constexpr std::uint32_t kFirstContactSettings = 40;
constexpr std::uint32_t kFirstObservation = offsetof(palpate_observation, lateral_offset);
constexpr std::uint32_t kFirstInfo = offsetof(palpate_library_info, min_lipschitz_bound);
static_assert(sizeof(palpate_settings) >= kFirstContactSettings);

constexpr double kRigid = 1e-9;  // tolerance of orthonormality of a rotation

palpate_observation translate(const ContactObservation& seen) noexcept {
  palpate_observation o{};
  o.status = seen.status;
  o.element = seen.point.element;
  copy(seen.contact_point, o.contact_point);
  copy(seen.point.natural, o.natural);
  copy(seen.normal, o.normal);
  o.depth = seen.deflection.depth;
  o.lateral = seen.lateral_distance;
  o.offset = seen.offset;
  o.energy = seen.energy;
  o.tank = seen.tank;
  o.absorbed = seen.absorbed;
  copy(seen.force, o.force_on_body);
  copy(seen.lateral_offset, o.lateral_offset);
  o.dissipated = seen.dissipated;
  o.relaxed_fraction = seen.relaxed_fraction;
  copy(seen.relaxed_lateral_force, o.relaxed_lateral_force);
  return o;
}

// The statuses of the C interface are those of the format.
static_assert(PALPATE_VERTEX_FITTED == static_cast<int>(palpate::ResponseStatus::Fitted));
static_assert(PALPATE_VERTEX_INTERPOLATED ==
              static_cast<int>(palpate::ResponseStatus::Interpolated));
static_assert(PALPATE_VERTEX_HOLE == static_cast<int>(palpate::ResponseStatus::Hole));

}  // namespace

int palpate::runtime::fail(int status, const char* text) noexcept {
  std::snprintf(last_error, sizeof last_error, "%s", text);
  return status;
}

palpate_library_info palpate_library::describe(const palpate::Library& library,
                                               const palpate::runtime::Surface& surface) {
  palpate_library_info info{};
  info.vertices = static_cast<std::int32_t>(library.positions.size());
  info.triangles = static_cast<std::int32_t>(library.triangles.size());
  info.stick = library.certificate.stick;
  info.slip = library.certificate.slip;
  info.min_lipschitz_bound = library.certificate.min_lipschitz_bound;
  info.lipschitz_bound = enforced_lipschitz_bound(library.certificate);
  info.friction = library.certificate.friction;
  info.depth = surface.deepest();
  copy(surface.low(), info.low);
  copy(surface.high(), info.high);
  return info;
}

extern "C" {

const char* palpate_version(void) {
  return PALPATE_VERSION;
}

const char* palpate_last_error(void) {
  return last_error;
}

const char* palpate_status_text(int status) {
  switch (status) {
    case PALPATE_OK:
      return "done";
    case PALPATE_ERROR_ARGUMENT:
      return "a null pointer or a value out of range";
    case PALPATE_ERROR_FILE:
      return "the file cannot be read: check path and permissions";
    case PALPATE_ERROR_FORMAT:
      return "not a valid response library: rebuild it with this version";
    case PALPATE_ERROR_MEMORY:
      return "out of memory";
    case PALPATE_ERROR_UNCERTIFIED:
      return "the loop is not certified passive on the device at this rate";
    case PALPATE_ERROR_MISMATCH:
      return "the deformation belongs to another library";
    default:
      return "unknown status";
  }
}

int palpate_library_load(const char* path, palpate_library** library) {
  if (library == nullptr)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_library_load: library is null");
  *library = nullptr;
  if (path == nullptr || *path == '\0')
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_library_load: path is null or empty");
  return guarded(PALPATE_ERROR_FORMAT, [&] {
    if (const std::string kind = palpate::other_kind_of_file(path); !kind.empty()) {
      const std::string text =
          std::string(path) + ": is not a regular file but " + kind + "; name a library";
      return fail(PALPATE_ERROR_FILE, text.c_str());
    }
    if (!std::ifstream(path, std::ios::binary)) {
      const std::string text = std::string(path) + ": cannot be opened; check path and permissions";
      return fail(PALPATE_ERROR_FILE, text.c_str());
    }
    *library = new palpate_library(palpate::read_library(path));
    return static_cast<int>(PALPATE_OK);
  });
}

int palpate_library_load_memory(const void* bytes, size_t size, palpate_library** library) {
  if (library == nullptr)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_library_load_memory: library is null");
  *library = nullptr;
  if (bytes == nullptr || size == 0)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_library_load_memory: bytes is null or size is 0");
  return guarded(PALPATE_ERROR_FORMAT, [&] {
    *library = new palpate_library(
        palpate::library_from_bytes(std::string_view(static_cast<const char*>(bytes), size)));
    return static_cast<int>(PALPATE_OK);
  });
}

void palpate_library_destroy(palpate_library* library) {
  delete library;
}

int palpate_library_describe(const palpate_library* library, palpate_library_info* info) {
  if (library == nullptr || info == nullptr) {
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_library_describe: null pointer");
  }
  if (info->size < kFirstInfo) {
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_library_describe: set info->size to sizeof");
  }
  give(library->info, info, info->size);
  return PALPATE_OK;
}

int palpate_library_vertices(const palpate_library* library, double* positions, size_t capacity) {
  return give_array("palpate_library_vertices", library == nullptr ? nullptr : &library->positions,
                    positions, capacity);
}

int palpate_library_normals(const palpate_library* library, double* normals, size_t capacity) {
  return give_array("palpate_library_normals", library == nullptr ? nullptr : &library->inward,
                    normals, capacity);
}

int palpate_library_triangles(const palpate_library* library, int32_t* triangles, size_t capacity) {
  return give_array("palpate_library_triangles", library == nullptr ? nullptr : &library->triangles,
                    triangles, capacity);
}

int palpate_library_vertex_statuses(const palpate_library* library, uint8_t* statuses,
                                    size_t capacity) {
  return give_array("palpate_library_vertex_statuses",
                    library == nullptr ? nullptr : &library->statuses, statuses, capacity);
}

void palpate_settings_default(palpate_settings* settings) {
  if (settings == nullptr) return;
  *settings = {sizeof(palpate_settings), -1.0, kDefaultTankCap, 0, 0};
}

int palpate_state_create(const palpate_library* library, const palpate_settings* settings,
                         palpate_state** state) {
  if (state == nullptr) return fail(PALPATE_ERROR_ARGUMENT, "palpate_state_create: state is null");
  *state = nullptr;
  if (library == nullptr)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_state_create: library is null");
  palpate_settings chosen;
  palpate_settings_default(&chosen);
  const bool sized = settings == nullptr || settings->size >= kFirstContactSettings;
  if (settings != nullptr && sized) give(*settings, &chosen, settings->size);
  if (!sized) {
    return fail(PALPATE_ERROR_ARGUMENT,
                "palpate_state_create: fill the settings with palpate_settings_default first");
  }
  if (!std::isfinite(chosen.friction) || !std::isfinite(chosen.tank_cap) || chosen.tank_cap < 0) {
    return fail(PALPATE_ERROR_ARGUMENT,
                "palpate_state_create: friction must be finite, tank_cap finite and not negative");
  }
  if (chosen.friction < 0 && !library->certified) {
    return fail(
        PALPATE_ERROR_ARGUMENT,
        "palpate_state_create: the library has no certificate and thus no friction of its own; "
        "set settings.friction");
  }
  if (!(chosen.lipschitz_bound >= 0) ||
      (chosen.lipschitz_bound > 0 && chosen.lipschitz_bound < library->min_lipschitz_bound)) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "palpate_state_create: lipschitz_bound must be 0, or at least the smallest bound that this "
        "library allows: %s",
        palpate::lipschitz_bound_text(library->min_lipschitz_bound).c_str());
    return fail(PALPATE_ERROR_ARGUMENT, text);
  }
  if (!(chosen.search_rate >= 0 && chosen.search_rate <= kMostSearchRate)) {
    return fail(PALPATE_ERROR_ARGUMENT,
                "palpate_state_create: search_rate must be 0 (no thread) to 10000 Hz");
  }
  ContactSettings contact;
  contact.friction = chosen.friction < 0 ? library->info.friction : chosen.friction;
  contact.tank_cap = chosen.tank_cap;
  contact.lipschitz_bound =
      chosen.lipschitz_bound > 0 ? chosen.lipschitz_bound : library->lipschitz_bound;
  return guarded(PALPATE_ERROR_FORMAT, [&] {
    *state = new palpate_state(*library, contact, chosen.search_rate);
    return static_cast<int>(PALPATE_OK);
  });
}

void palpate_state_destroy(palpate_state* state) {
  delete state;
}

void palpate_state_reset(palpate_state* state) {
  if (state != nullptr) state->reset();
}

void palpate_device_constants_default(palpate_device_constants* device) {
  if (device == nullptr) return;
  constexpr double kUnknown = palpate::kUnknown;
  *device = {sizeof(palpate_device_constants), kUnknown, kUnknown, kUnknown, kUnknown, kUnknown};
}

int palpate_state_certified(const palpate_state* state, const palpate_device_constants* device,
                            double rate) {
  if (state == nullptr || device == nullptr)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_state_certified: null pointer");
  if (device->size < sizeof(palpate_device_constants)) {
    return fail(PALPATE_ERROR_ARGUMENT,
                "palpate_state_certified: fill the constants with palpate_device_constants_default "
                "first");
  }
  if (!(rate > 0 && std::isfinite(rate)))
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_state_certified: the rate must be above 0");
  for (const double constant : {device->damping, device->coulomb_friction, device->delay,
                                device->position_resolution, device->force_resolution}) {
    if (std::isnan(constant) || (constant >= 0 && std::isfinite(constant))) continue;
    return fail(PALPATE_ERROR_ARGUMENT,
                "palpate_state_certified: a constant of the device is negative or infinite; give "
                "NaN for what is not known");
  }
  return guarded(PALPATE_ERROR_MEMORY, [&] {
    const std::string reason = palpate::runtime::why_not_certified(
        *state,
        {device->damping, device->coulomb_friction, device->delay, device->position_resolution,
         device->force_resolution},
        rate);
    return reason.empty() ? 1 : fail(0, reason.c_str());
  });
}

int palpate_state_set_pose(palpate_state* state, const double position[3],
                           const double rotation[9]) {
  if (state == nullptr || position == nullptr || rotation == nullptr)
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_state_set_pose: null pointer");
  palpate::runtime::Pose pose;
  std::copy_n(position, 3, pose.position.begin());
  for (std::size_t i = 0; i < 3; ++i) std::copy_n(rotation + 3 * i, 3, pose.rotation[i].begin());
  if (!pose.is_rigid(kRigid)) {
    return fail(PALPATE_ERROR_ARGUMENT,
                "palpate_state_set_pose: position must be finite and rotation orthonormal and "
                "right-handed");
  }
  state->set_pose(pose);
  return PALPATE_OK;
}

uint32_t palpate_step(palpate_state* state, const double position[3], const double velocity[3],
                      double dt, double force[3]) {
  if (force != nullptr) std::fill_n(force, 3, 0.0);
  if (state == nullptr) return PALPATE_BAD_INPUT;
  const bool usable = position != nullptr && velocity != nullptr && force != nullptr &&
                      std::isfinite(dt) && dt > 0 && std::isfinite(velocity[0]) &&
                      std::isfinite(velocity[1]) && std::isfinite(velocity[2]);
  if (!usable) return state->refuse();
  const uint32_t status = state->step({position[0], position[1], position[2]}, dt);
  copy(state->command(), force);
  return status;
}

int palpate_observe(const palpate_state* state, palpate_observation* observation) {
  if (state == nullptr || observation == nullptr) {
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_observe: null pointer");
  }
  if (observation->size < kFirstObservation) {
    return fail(PALPATE_ERROR_ARGUMENT, "palpate_observe: set observation->size to sizeof");
  }
  give(translate(state->observe()), observation, observation->size);
  return PALPATE_OK;
}

}  // extern "C"
