// SPDX-License-Identifier: Apache-2.0
// What the classes of the artifacts have in common.
#pragma once

#include <vector>

#include <pybind11/pybind11.h>

namespace palpate::python {

/// A list of the elements, which keep `owner` alive.
template <class Element>
pybind11::list references(pybind11::handle owner, const std::vector<Element>& elements) {
  pybind11::list list;
  for (const Element& element : elements)
    list.append(pybind11::cast(element, pybind11::return_value_policy::reference_internal, owner));
  return list;
}

// Each adds its classes and functions to the module.
void define_provenance(pybind11::module_& module);
void define_body(pybind11::module_& module);
void define_curves(pybind11::module_& module);
void define_recording(pybind11::module_& module);

inline constexpr const char* kProvenanceText =
    "The stages that the file has been through, oldest first: a list of ProvenanceStep.";

}  // namespace palpate::python
