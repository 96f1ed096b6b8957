// SPDX-License-Identifier: Apache-2.0
// Arguments that are arrays of numbers.
#pragma once

#include <optional>
#include <string>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "format/vec3.hpp"

namespace palpate::python {

using Doubles = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

/// Any array or sequence of real numbers as contiguous doubles, without a copy where it is that
/// already. Throws TypeError for everything else: truth values, complex numbers, text. `name`: of
/// the argument.
Doubles doubles_of(pybind11::handle argument, const std::string& name);

/// The same of one shape; -1 stands for any length. Throws ArgumentError for another shape.
Doubles doubles_of(pybind11::handle argument, const std::string& name, pybind11::ssize_t rows,
                   std::optional<pybind11::ssize_t> columns = {});

/// Three numbers.
Vec3 vector_of(pybind11::handle argument, const std::string& name);

/// A number that was given, for messages, "nan" and "inf" as Python prints them.
std::string given_text(double number);

/// "(4, 3)"
std::string shape_text(const pybind11::array& array);

/// Row of the first number that is not finite. The array has one or two axes.
std::optional<pybind11::ssize_t> first_not_finite(const Doubles& array);

}  // namespace palpate::python
