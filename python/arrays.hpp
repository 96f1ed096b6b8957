// SPDX-License-Identifier: Apache-2.0
// Records of palpate as numpy arrays that cannot be written, without a copy.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace palpate::python {

/// A value of an array, or a row of several.
template <class Field>
struct RowOf {
  using Number = Field;
  static constexpr std::size_t kNumbers = 0;  ///< 0: no second axis
};
template <class T, std::size_t N>
struct RowOf<std::array<T, N>> {
  using Number = T;
  static constexpr std::size_t kNumbers = N;
};

/// An array over the memory of `owner`, which it keeps alive. `first`: the first of `rows` values,
/// `stride` bytes apart; may be null where there is none.
template <class Field>
pybind11::array view(pybind11::handle owner, const Field* first, std::size_t rows,
                     std::size_t stride = sizeof(Field)) {
  using Row = RowOf<Field>;
  std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(rows)};
  std::vector<pybind11::ssize_t> strides{static_cast<pybind11::ssize_t>(stride)};
  if (Row::kNumbers > 0) {
    shape.push_back(static_cast<pybind11::ssize_t>(Row::kNumbers));
    strides.push_back(sizeof(typename Row::Number));
  }
  pybind11::array made(pybind11::dtype::of<typename Row::Number>(), shape, strides, first, owner);
  made.attr("setflags")(pybind11::arg("write") = false);
  return made;
}

/// The same over a vector that `owner` holds.
template <class Field>
pybind11::array view(pybind11::handle owner, const std::vector<Field>& values) {
  return view(owner, values.data(), values.size());
}

/// Three numbers of a record as a vector of their own.
template <class T, std::size_t N>
pybind11::array view_of_row(pybind11::handle owner, const T (&row)[N]) {
  return view(owner, &row[0], N);
}
template <class T, std::size_t N>
pybind11::array view_of_row(pybind11::handle owner, const std::array<T, N>& row) {
  return view(owner, row.data(), N);
}

/// A property: the vector of a record of type Owner.
template <class Owner, class Field>
auto array_of(std::vector<Field> Owner::*member) {
  return [member](const pybind11::object& self) {
    return view(self, self.cast<const Owner&>().*member);
  };
}

/// A property: one field of the records in a vector of Owner.
template <class Owner, class Holder, class Record, class Field>
auto column_of(std::vector<Record> Holder::*records, Field Record::*field) {
  return [records, field](const pybind11::object& self) {
    const std::vector<Record>& rows = self.cast<const Owner&>().*records;
    const Field* first = rows.empty() ? nullptr : &(rows.front().*field);
    return view(self, first, rows.size(), sizeof(Record));
  };
}

/// A property: one vector of a record.
template <class Owner, class Row>
auto row_of(Row Owner::*member) {
  return [member](const pybind11::object& self) {
    return view_of_row(self, self.cast<const Owner&>().*member);
  };
}

}  // namespace palpate::python
