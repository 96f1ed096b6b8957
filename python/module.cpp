// SPDX-License-Identifier: Apache-2.0
// The extension palpate._palpate; palpate/__init__.py gives its names to the user.
#include <pybind11/pybind11.h>

#include "python/objects.hpp"
#include "runtime/palpate.h"

PYBIND11_MODULE(_palpate, module) {
  pybind11::options options;
  options.disable_function_signatures();
  module.attr("__version__") = palpate_version();
  palpate::python::define_library(module);
}
