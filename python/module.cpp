// SPDX-License-Identifier: Apache-2.0
// The extension palpate._palpate; palpate/__init__.py gives its names to the user.
#include <pybind11/pybind11.h>

#include "python/artifacts.hpp"
#include "python/deformation.hpp"
#include "python/objects.hpp"
#include "python/status.hpp"
#include "runtime/palpate.h"

PYBIND11_MODULE(_palpate, module) {
  pybind11::options options;
  options.disable_function_signatures();
  module.attr("__version__") = palpate_version();
  palpate::python::define_status(module);
  palpate::python::define_provenance(module);
  palpate::python::define_library(module);
  auto state = palpate::python::define_state(module);
  palpate::python::define_deformation(module, state);
  palpate::python::define_body(module);
  palpate::python::define_curves(module);
  palpate::python::define_recording(module);
}
