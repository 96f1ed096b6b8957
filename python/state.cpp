// SPDX-License-Identifier: Apache-2.0
// palpate.State: one tool on one body.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "python/arrays.hpp"
#include "python/errors.hpp"
#include "python/numbers.hpp"
#include "python/objects.hpp"
#include "python/status.hpp"

namespace py = pybind11;

namespace palpate::python {

std::shared_ptr<StateObject> make_state(const std::shared_ptr<LibraryObject>& library,
                                        std::optional<double> friction, double tank_cap,
                                        std::optional<double> lipschitz_bound, double search_rate) {
  if (friction && !(*friction >= 0)) {
    raise("ArgumentError",
          "Library.state: friction is " + given_text(*friction) +
              "; give a coefficient of at least 0, or None for that of the certificate");
  }
  palpate_settings settings{};
  palpate_settings_default(&settings);
  settings.friction = friction.value_or(-1);
  settings.tank_cap = tank_cap;
  settings.lipschitz_bound = lipschitz_bound.value_or(0);
  settings.search_rate = search_rate;
  palpate_state* made = nullptr;
  check_call(palpate_state_create(&library->handle, &settings, &made));
  return std::make_shared<StateObject>(library, made);
}

namespace {

/// A use of a state by the calling thread. Throws BusyError where another thread uses it.
class Use {
 public:
  explicit Use(StateObject& state) : state_(state) {
    if (state.busy.exchange(true, std::memory_order_acquire)) {
      raise("BusyError",
            "State: another thread uses it; a state belongs to one thread at a time, "
            "make one for each");
    }
  }
  ~Use() { state_.busy.store(false, std::memory_order_release); }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  StateObject& state_;
};

void require_finite(const Doubles& array, const std::string& name) {
  const auto row = first_not_finite(array);
  if (!row) return;
  const std::string place = array.ndim() == 2 ? "[" + std::to_string(*row) + "]" : "";
  raise("ArgumentError", name + place +
                             ": is not finite; give finite numbers, or strict=False for what a "
                             "force loop does with them");
}

void require_times(const Doubles& dt, const std::string& name) {
  for (py::ssize_t i = 0; i < dt.size(); ++i) {
    if (dt.data()[i] > 0 && std::isfinite(dt.data()[i])) continue;
    const std::string place = dt.ndim() == 1 ? "[" + std::to_string(i) + "]" : "";
    raise("ArgumentError", name + place + ": is " + given_text(dt.data()[i]) +
                               " s; give the time since the last step, above 0");
  }
}

py::tuple step(StateObject& state, const py::object& position, const py::object& velocity,
               double dt, bool strict) {
  const Doubles x = doubles_of(position, "State.step: position", 3);
  const Doubles v = doubles_of(velocity, "State.step: velocity", 3);
  if (strict) {
    require_finite(x, "State.step: position");
    require_finite(v, "State.step: velocity");
    if (!(dt > 0 && std::isfinite(dt))) {
      raise("ArgumentError", "State.step: dt is " + given_text(dt) +
                                 " s; give the time since the last step, above 0");
    }
  }
  py::array_t<double> force(3);
  const Use use(state);
  const std::uint32_t status =
      palpate_step(state.handle.get(), x.data(), v.data(), dt, force.mutable_data());
  return py::make_tuple(force, status_of(status));
}

palpate_observation seen_by(const palpate_state* state) {
  palpate_observation seen{};
  seen.size = sizeof seen;
  check_call(palpate_observe(state, &seen));
  return seen;
}

palpate_observation observe(StateObject& state) {
  const Use use(state);
  return seen_by(state.handle.get());
}

void set_pose(StateObject& state, const py::object& position, const py::object& rotation) {
  const Vec3 x = vector_of(position, "State.set_pose: position");
  std::array<double, 9> rows{1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (!rotation.is_none()) {
    const Doubles given = doubles_of(rotation, "State.set_pose: rotation", 3, 3);
    std::copy_n(given.data(), rows.size(), rows.begin());
  }
  if (!is_finite(x)) {
    raise("ArgumentError", "State.set_pose: position is not finite; give finite numbers, in m");
  }
  const Use use(state);
  check_call(palpate_state_set_pose(state.handle.get(), x.data(), rows.data()));
}

void reset(StateObject& state) {
  const Use use(state);
  palpate_state_reset(state.handle.get());
}

void require_constant(double value, const char* name, const char* unit) {
  if (std::isnan(value) || (value >= 0 && std::isfinite(value))) return;
  raise("ArgumentError", std::string("State.certified: ") + name + " is " + given_text(value) +
                             " " + unit +
                             "; give a finite value of at least 0, or nan where it is not known");
}

py::tuple certified(StateObject& state, double rate, double damping, double coulomb_friction,
                    double delay, double position_resolution, double force_resolution) {
  if (!(rate > 0 && std::isfinite(rate))) {
    raise("ArgumentError",
          "State.certified: rate is " + given_text(rate) + " Hz; give a rate above 0");
  }
  require_constant(damping, "damping", "N s/m");
  require_constant(coulomb_friction, "coulomb_friction", "N");
  require_constant(delay, "delay", "s");
  require_constant(position_resolution, "position_resolution", "m");
  require_constant(force_resolution, "force_resolution", "N");
  const palpate_device_constants device{sizeof(palpate_device_constants),
                                        damping,
                                        coulomb_friction,
                                        delay,
                                        position_resolution,
                                        force_resolution};
  const Use use(state);
  const int is = palpate_state_certified(state.handle.get(), &device, rate);
  check_call(is);
  return py::make_tuple(is == 1, is == 1 ? "" : palpate_last_error());
}

/// A step of a trajectory.
struct RunStep {
  Vec3 force{};
  std::uint32_t status = 0;
  std::int32_t element = -1;
  Vec3 contact_point{}, normal{};
  double depth = 0, lateral = 0, offset = 0, energy = 0, tank = 0, absorbed = 0, dissipated = 0,
         relaxed_fraction = 0;
};

struct Run {
  std::vector<RunStep> steps;
};

/// The motion that State.run makes. Velocities and times of a single row serve for every step.
struct Motion {
  Doubles positions, velocities, times;
  std::size_t steps() const { return static_cast<std::size_t>(positions.shape(0)); }
  const double* position(std::size_t i) const { return positions.data() + 3 * i; }
  const double* velocity(std::size_t i) const { return velocities.data() + 3 * i; }
  double dt(std::size_t i) const { return times.data()[times.ndim() == 0 ? 0 : i]; }
};

/// Backward differences; nothing before the first.
Doubles differences(const Doubles& x, const Doubles& times) {
  Doubles v(std::vector<py::ssize_t>{x.shape(0), 3});
  for (py::ssize_t i = 0; i < x.size(); ++i) {
    const double dt = times.data()[times.ndim() == 0 ? 0 : i / 3];
    v.mutable_data()[i] = i < 3 ? 0 : (x.data()[i] - x.data()[i - 3]) / dt;
  }
  return v;
}

Motion motion_of(const py::object& positions, const py::object& velocities, const py::object& dt,
                 bool strict) {
  Motion motion;
  motion.positions = doubles_of(positions, "State.run: positions", -1, 3);
  const py::ssize_t steps = motion.positions.shape(0);
  motion.times = doubles_of(dt, "State.run: dt");
  if (motion.times.ndim() != 0) motion.times = doubles_of(dt, "State.run: dt", steps);
  if (strict) {
    require_finite(motion.positions, "State.run: positions");
    require_times(motion.times, "State.run: dt");
  }
  motion.velocities = velocities.is_none()
                          ? differences(motion.positions, motion.times)
                          : doubles_of(velocities, "State.run: velocities", steps, 3);
  if (strict) require_finite(motion.velocities, "State.run: velocities");
  return motion;
}

/// Neither allocates nor needs the GIL.
RunStep run_step(palpate_state* state, const double* position, const double* velocity, double dt) {
  RunStep made;
  made.status = palpate_step(state, position, velocity, dt, made.force.data());
  palpate_observation seen{};
  seen.size = sizeof seen;
  palpate_observe(state, &seen);
  made.element = seen.element;
  std::copy_n(seen.contact_point, 3, made.contact_point.begin());
  std::copy_n(seen.normal, 3, made.normal.begin());
  made.depth = seen.depth;
  made.lateral = seen.lateral;
  made.offset = seen.offset;
  made.energy = seen.energy;
  made.tank = seen.tank;
  made.absorbed = seen.absorbed;
  made.dissipated = seen.dissipated;
  made.relaxed_fraction = seen.relaxed_fraction;
  return made;
}

Run run(StateObject& state, const py::object& positions, const py::object& velocities,
        const py::object& dt, bool strict) {
  constexpr std::size_t kBetweenSignals = 1 << 16;
  const Motion motion = motion_of(positions, velocities, dt, strict);
  const Use use(state);
  Run made;
  made.steps.resize(motion.steps());
  for (std::size_t first = 0; first < motion.steps(); first += kBetweenSignals) {
    const std::size_t end = std::min(motion.steps(), first + kBetweenSignals);
    {
      const py::gil_scoped_release released;
      for (std::size_t i = first; i < end; ++i)
        made.steps[i] =
            run_step(state.handle.get(), motion.position(i), motion.velocity(i), motion.dt(i));
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return made;
}

template <class Field>
auto of_run(Field RunStep::*field) {
  return column_of<Run>(&Run::steps, field);
}

void define_run(py::module_& module) {
  py::class_<Run>(module, "Run",
                  "What State.run made: one row a step, after that step. Arrays are read-only "
                  "views with strides,\n"
                  "which keep the memory of the whole run, about 200 bytes a step.")
      .def("__len__", [](const Run& run) { return run.steps.size(); })
      .def_property_readonly("force", of_run(&RunStep::force), "(N, 3) N, of the body on the tool.")
      .def_property_readonly("status", of_run(&RunStep::status),
                             "(N,) uint32: bits of Status, e.g. run.status & Status.SLIDING != 0.")
      .def_property_readonly("element", of_run(&RunStep::element),
                             "(N,) int32: active triangle, -1 without contact.")
      .def_property_readonly("contact_point", of_run(&RunStep::contact_point),
                             "(N, 3) m: c, in the world.")
      .def_property_readonly("normal", of_run(&RunStep::normal),
                             "(N, 3): n, unit, into the body, in the world.")
      .def_property_readonly("depth", of_run(&RunStep::depth), "(N,) m: z = n . (x - c) - d0.")
      .def_property_readonly("lateral", of_run(&RunStep::lateral),
                             "(N,) m: lateral distance of the tip from the anchor.")
      .def_property_readonly("offset", of_run(&RunStep::offset), "(N,) m: depth offset d0.")
      .def_property_readonly("energy", of_run(&RunStep::energy), "(N,) J: stored in the body.")
      .def_property_readonly("tank", of_run(&RunStep::tank), "(N,) J: energy tank.")
      .def_property_readonly(
          "absorbed", of_run(&RunStep::absorbed),
          "(N,) J: net work of the tool on the body since the state was made or reset.")
      .def_property_readonly("dissipated", of_run(&RunStep::dissipated),
                             "(N,) J: dissipated by relaxation.")
      .def_property_readonly("relaxed_fraction", of_run(&RunStep::relaxed_fraction),
                             "(N,): fraction of the instantaneous normal force that has relaxed.");
}

template <std::size_t N>
auto row_of_observation(double (palpate_observation::*member)[N]) {
  return [member](const py::object& self) {
    return view_of_row(self, self.cast<const palpate_observation&>().*member);
  };
}

void define_observation(py::module_& module) {
  using Seen = palpate_observation;
  py::class_<Seen>(module, "Observation", "The state after its last step.")
      .def_property_readonly(
          "status", [](const Seen& seen) { return status_of(seen.status); },
          "Status of the last step.")
      .def_readonly("element", &Seen::element, "Active triangle, -1 without contact.")
      .def_property_readonly("contact_point", row_of_observation(&Seen::contact_point),
                             "(3,) m: c.")
      .def_property_readonly("natural", row_of_observation(&Seen::natural),
                             "(3,): natural coordinates of c in the triangle.")
      .def_property_readonly("normal", row_of_observation(&Seen::normal),
                             "(3,): n, unit, into the body.")
      .def_readonly("depth", &Seen::depth, "m: z = n . (x - c) - d0.")
      .def_readonly("lateral", &Seen::lateral, "m: lateral distance of the tip from the anchor.")
      .def_readonly("offset", &Seen::offset, "m: depth offset d0.")
      .def_readonly("energy", &Seen::energy, "J: stored in the body.")
      .def_readonly("tank", &Seen::tank, "J: energy tank.")
      .def_readonly("absorbed", &Seen::absorbed, "J: net work of the tool on the body.")
      .def_property_readonly("force_on_body", row_of_observation(&Seen::force_on_body),
                             "(3,) N: the opposite of the force of the step.")
      .def_property_readonly("lateral_offset", row_of_observation(&Seen::lateral_offset),
                             "(3,) m: slip that the contact point has not followed.")
      .def_readonly("dissipated", &Seen::dissipated, "J: dissipated by relaxation.")
      .def_readonly("relaxed_fraction", &Seen::relaxed_fraction,
                    "Fraction of the instantaneous normal force that has relaxed.")
      .def_property_readonly("relaxed_lateral_force",
                             row_of_observation(&Seen::relaxed_lateral_force),
                             "(3,) N: what has relaxed of the instantaneous lateral force.");
}

constexpr const char* kStateText =
    "One tool on one body; made by Library.state.\n\n"
    "It belongs to one thread at a time: BusyError where another thread uses it, State.deform "
    "excepted.\n"
    "Inputs must be finite: what is not raises ArgumentError before the step, and the state is as "
    "it was. With\n"
    "strict=False they do what they do in a force loop: the force is zero, the contact is dropped, "
    "and the status\n"
    "has BAD_INPUT.";
constexpr const char* kStepText =
    "step(position, velocity, dt, *, strict=True) -> (force, status)\n\n"
    "One step of the force loop. position: (3,) m, tip of the tool; velocity: (3,) m/s; dt: s "
    "since the last step.\n"
    "force: (3,) N, of the body on the tool, to the bit that of palpate_step; status: Status.";
constexpr const char* kRunText =
    "run(positions, velocities=None, dt=0.001, *, strict=True) -> Run\n\n"
    "A whole trajectory, a step a row, to the bit what `step` gives. positions: (N, 3) m; "
    "velocities: (N, 3) m/s,\n"
    "None: backward differences; dt: s, one for all or (N,). Runs without the GIL. All inputs are "
    "checked before the\n"
    "first step. Ctrl-C ends it between steps.";
constexpr const char* kPoseText =
    "set_pose(position, rotation=None)\n\n"
    "x_world = rotation x_body + position. position: (3,) m; rotation: (3, 3), orthonormal and "
    "right-handed, None: none.\n"
    "May be called between steps, also in contact, in small steps. Raises ArgumentError for "
    "another matrix.";
constexpr const char* kCertifiedText =
    "certified(rate, *, damping=nan, coulomb_friction=nan, delay=nan, position_resolution=nan, "
    "force_resolution=nan)\n"
    "    -> (certified, reason)\n\n"
    "Whether a device renders this state passively at this rate of the force loop (Hz), and why "
    "not. damping: N s/m,\n"
    "coulomb_friction: N, delay: s beyond one sample, resolutions: m and N. What is not known "
    "(nan) "
    "is not certified. Raises ArgumentError\n"
    "for negative and infinite values.";

}  // namespace

StateClass define_state(py::module_& module) {
  define_observation(module);
  define_run(module);
  constexpr double kUnknown = palpate::kUnknown;
  StateClass made(module, "State", kStateText);
  made.def_property_readonly(
          "library", [](const StateObject& state) { return state.library; }, "The Library.")
      .def_property_readonly(
          "friction", [](const StateObject& state) { return state.handle->friction; },
          "Friction coefficient in use.")
      .def_property_readonly(
          "lipschitz_bound", [](const StateObject& state) { return state.handle->lipschitz_bound; },
          "N/m, bound of the force in use; may be infinite.")
      .def("step", &step, py::arg("position"), py::arg("velocity"), py::arg("dt"), py::kw_only(),
           py::arg("strict") = true, kStepText)
      .def("run", &run, py::arg("positions"), py::arg("velocities") = py::none(),
           py::arg("dt") = 1e-3, py::kw_only(), py::arg("strict") = true, kRunText)
      .def("observe", &observe, "observe() -> Observation\n\nThe state after its last step.")
      .def("set_pose", &set_pose, py::arg("position"), py::arg("rotation") = py::none(), kPoseText)
      .def("reset", &reset,
           "reset()\n\nEnds the contact and sets all energies to zero. The pose remains.")
      .def("certified", &certified, py::arg("rate"), py::kw_only(), py::arg("damping") = kUnknown,
           py::arg("coulomb_friction") = kUnknown, py::arg("delay") = kUnknown,
           py::arg("position_resolution") = kUnknown, py::arg("force_resolution") = kUnknown,
           kCertifiedText);
  return made;
}

}  // namespace palpate::python
