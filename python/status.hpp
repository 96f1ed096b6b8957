// SPDX-License-Identifier: Apache-2.0
// The status bits of palpate.h, of which palpate/_status.py makes palpate.Status.
#pragma once

#include <cstdint>

#include <pybind11/pybind11.h>

namespace palpate::python {

void define_status(pybind11::module_& module);
/// A palpate.Status.
pybind11::object status_of(std::uint32_t bits);

}  // namespace palpate::python
