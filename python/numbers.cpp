// SPDX-License-Identifier: Apache-2.0
#include "python/numbers.hpp"

#include <cmath>

#include "format/number_text.hpp"
#include "python/errors.hpp"

namespace py = pybind11;

namespace palpate::python {
namespace {

bool is_real(const py::array& array) {
  const char kind = array.dtype().kind();
  return kind == 'f' || kind == 'i' || kind == 'u';
}

std::string wanted_text(py::ssize_t rows, std::optional<py::ssize_t> columns) {
  const std::string first = rows < 0 ? "N" : std::to_string(rows);
  return columns ? "(" + first + ", " + std::to_string(*columns) + ")" : "(" + first + ",)";
}

}  // namespace

std::string given_text(double number) {
  return std::isfinite(number) ? number_text(number) : std::string(py::repr(py::float_(number)));
}

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis)
    text += (axis > 0 ? ", " : "") + std::to_string(array.shape(axis));
  return text + (array.ndim() == 1 ? ",)" : ")");
}

Doubles doubles_of(py::handle argument, const std::string& name) {
  const py::array array = py::array::ensure(argument);
  if (!array) raise_type_error(name + ": is no array of numbers; give real numbers in equal rows");
  if (!is_real(array)) {
    raise_type_error(name + ": has dtype " + std::string(py::str(array.dtype())) +
                     "; give real numbers");
  }
  return Doubles::ensure(array);
}

Doubles doubles_of(py::handle argument, const std::string& name, py::ssize_t rows,
                   std::optional<py::ssize_t> columns) {
  Doubles array = doubles_of(argument, name);
  const bool fits = array.ndim() == (columns ? 2 : 1) && (rows < 0 || array.shape(0) == rows) &&
                    (!columns || array.shape(1) == *columns);
  if (!fits) {
    raise("ArgumentError", name + ": has shape " + shape_text(array) + "; give an array of shape " +
                               wanted_text(rows, columns));
  }
  return array;
}

Vec3 vector_of(py::handle argument, const std::string& name) {
  const Doubles array = doubles_of(argument, name, 3);
  return {array.at(0), array.at(1), array.at(2)};
}

std::optional<py::ssize_t> first_not_finite(const Doubles& array) {
  const py::ssize_t row = array.ndim() == 2 ? array.shape(1) : 1;
  for (py::ssize_t i = 0; i < array.size(); ++i)
    if (!std::isfinite(array.data()[i])) return i / row;
  return {};
}

}  // namespace palpate::python
