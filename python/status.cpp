// SPDX-License-Identifier: Apache-2.0
#include "python/status.hpp"

#include <array>
#include <utility>

#include "runtime/palpate.h"

namespace py = pybind11;

namespace palpate::python {
namespace {

constexpr std::array<std::pair<const char*, std::uint32_t>, 22> kBits{{
    {"CONTACT", PALPATE_CONTACT},
    {"ACTIVATED", PALPATE_ACTIVATED},
    {"RELEASED", PALPATE_RELEASED},
    {"SLIDING", PALPATE_SLIDING},
    {"AT_BORDER", PALPATE_AT_BORDER},
    {"ENERGY_LIMITED", PALPATE_ENERGY_LIMITED},
    {"BEYOND_DEPTH", PALPATE_BEYOND_DEPTH},
    {"BAD_INPUT", PALPATE_BAD_INPUT},
    {"DROPPED", PALPATE_DROPPED},
    {"FORCE_LIMITED", PALPATE_FORCE_LIMITED},
    {"AWAITING", PALPATE_AWAITING},
    {"SKIN_LAGS", PALPATE_SKIN_LAGS},
    {"LOOP_RAMPING", PALPATE_LOOP_RAMPING},
    {"LOOP_CLAMPED", PALPATE_LOOP_CLAMPED},
    {"LOOP_TOO_FAST", PALPATE_LOOP_TOO_FAST},
    {"LOOP_LATE", PALPATE_LOOP_LATE},
    {"LOOP_NOT_FINITE", PALPATE_LOOP_NOT_FINITE},
    {"LOOP_SATURATED", PALPATE_LOOP_SATURATED},
    {"LOOP_STALE", PALPATE_LOOP_STALE},
    {"LOOP_DEVICE_LOST", PALPATE_LOOP_DEVICE_LOST},
    {"LOOP_OUTDATED", PALPATE_LOOP_OUTDATED},
    {"LOOP_REJECTED", PALPATE_LOOP_REJECTED},
}};

}  // namespace

void define_status(py::module_& module) {
  py::dict bits;
  for (const auto& [name, bit] : kBits) bits[name] = bit;
  module.attr("_status_bits") = bits;
}

py::object status_of(std::uint32_t bits) {
  // Never destroyed: the interpreter may be gone before static objects are.
  static const auto* status = new py::object(py::module_::import("palpate._status").attr("Status"));
  return (*status)(bits);
}

}  // namespace palpate::python
