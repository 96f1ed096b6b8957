// SPDX-License-Identifier: Apache-2.0
// What stands behind the classes of the package.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <utility>

#include <pybind11/pybind11.h>

#include "format/library.hpp"
#include "runtime/handles.hpp"
#include "runtime/palpate.h"

namespace palpate::python {

/// palpate.Library: the file as it was read, and what the runtime makes of it.
struct LibraryObject {
  explicit LibraryObject(Library read) : file(std::move(read)), handle(file) {}

  Library file;
  palpate_library handle;
};

/// palpate.State. Its library lives at least as long.
struct StateObject {
  StateObject(std::shared_ptr<LibraryObject> of, palpate_state* made)
      : library(std::move(of)), handle(made, &palpate_state_destroy) {}

  std::shared_ptr<LibraryObject> library;
  std::unique_ptr<palpate_state, decltype(&palpate_state_destroy)> handle;
  std::atomic<bool> busy = false;  ///< a thread uses it
};

/// Library.state. No friction: that of the certificate; no bound: that of the library.
std::shared_ptr<StateObject> make_state(const std::shared_ptr<LibraryObject>& library,
                                        std::optional<double> friction, double tank_cap,
                                        std::optional<double> lipschitz_bound, double search_rate);

// Each adds its classes and functions to the module.
void define_library(pybind11::module_& module);
using StateClass = pybind11::class_<StateObject, std::shared_ptr<StateObject>>;
StateClass define_state(pybind11::module_& module);

}  // namespace palpate::python
