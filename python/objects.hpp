// SPDX-License-Identifier: Apache-2.0
// What stands behind the classes of the package.
#pragma once

#include <memory>
#include <utility>

#include <pybind11/pybind11.h>

#include "format/library.hpp"
#include "runtime/handles.hpp"

namespace palpate::python {

/// palpate.Library: the file as it was read, and what the runtime makes of it.
struct LibraryObject {
  explicit LibraryObject(Library read) : file(std::move(read)), handle(file) {}

  Library file;
  palpate_library handle;
};

// Each adds its classes and functions to the module.
void define_library(pybind11::module_& module);

}  // namespace palpate::python
