// SPDX-License-Identifier: Apache-2.0
// palpate.Deformation: the skin as it is pressed.
#include "python/deformation.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl/filesystem.h>

#include <string>
#include <utility>

#include "python/arrays.hpp"
#include "python/errors.hpp"
#include "python/numbers.hpp"

namespace py = pybind11;

namespace palpate::python {

DeformationObject::DeformationObject(std::shared_ptr<LibraryObject> of, palpate_deformation* made)
    : library(std::move(of)), handle(made, &palpate_deformation_destroy) {
  info.size = sizeof info;
  check_call(palpate_deformation_describe(made, &info));
  positions.resize(static_cast<std::size_t>(info.vertices));
  triangles.resize(static_cast<std::size_t>(info.triangles));
  check_call(palpate_deformation_vertices(made, positions.front().data(), positions.size()));
  check_call(palpate_deformation_triangles(made, triangles.front().data(), triangles.size()));
}

std::shared_ptr<DeformationObject> load_deformation(const std::shared_ptr<LibraryObject>& library,
                                                    const std::filesystem::path& path) {
  palpate_deformation* made = nullptr;
  int status = PALPATE_OK;
  {
    const py::gil_scoped_release released;
    status = palpate_deformation_load(&library->handle, path.c_str(), &made);
  }
  check_call(status);
  return std::make_shared<DeformationObject>(library, made);
}

namespace {

using Out = py::array_t<double, py::array::c_style>;

/// The array of the caller, or a new one.
Out room_for(const DeformationObject& deformation, const py::object& out) {
  const auto rows = static_cast<py::ssize_t>(deformation.positions.size());
  if (out.is_none()) return Out(std::vector<py::ssize_t>{rows, 3});
  const bool fits = Out::check_(out) && py::cast<py::array>(out).writeable() &&
                    py::cast<py::array>(out).ndim() == 2 &&
                    py::cast<py::array>(out).shape(0) == rows &&
                    py::cast<py::array>(out).shape(1) == 3;
  if (!fits) {
    raise("ArgumentError",
          "State.deform: out: give a writeable contiguous array of float64 of shape (" +
              std::to_string(rows) + ", 3)");
  }
  return py::reinterpret_borrow<Out>(out);
}

Out deform(const StateObject& state, const DeformationObject& deformation, const py::object& out) {
  Out positions = room_for(deformation, out);
  double* to = positions.mutable_data();
  int status = PALPATE_OK;
  {
    const py::gil_scoped_release released;
    status = palpate_deform(state.handle.get(), deformation.handle.get(), to,
                            deformation.positions.size());
  }
  check_call(status);
  return positions;
}

template <class Value>
auto of_info(Value palpate_deformation_info::*member) {
  return [member](const DeformationObject& deformation) { return deformation.info.*member; };
}

constexpr const char* kDeformText =
    "deform(deformation, out=None) -> positions\n\n"
    "(W, 3) m: the vertices of the skin in the world, as the last step left them. out: an array to "
    "fill, float64 and\n"
    "contiguous. May be called from any thread beside the one that steps the state. Raises "
    "MismatchError where the\n"
    "deformation belongs to another Library object.";

}  // namespace

void define_deformation(py::module_& module, StateClass& state) {
  py::class_<DeformationObject, std::shared_ptr<DeformationObject>>(
      module, "Deformation",
      "How the skin moves under the tool; made by Library.deformation. Immutable, for any thread.")
      .def_property_readonly(
          "vertices", array_of(&DeformationObject::positions),
          "(W, 3) float64, m: the skin at rest, in the frame of the body; read-only view.")
      .def_property_readonly("triangles", array_of(&DeformationObject::triangles),
                             "(F, 3) int32, counter-clockwise from outside; read-only view.")
      .def_property_readonly("sites", of_info(&palpate_deformation_info::sites),
                             "Sites that the displacements are blended from.")
      .def_property_readonly("modes", of_info(&palpate_deformation_info::modes), "Shared modes.")
      .def_property_readonly("depth", of_info(&palpate_deformation_info::depth),
                             "m, deepest stored displacement; beyond it they go straight on.")
      .def_property_readonly(
          "reach", of_info(&palpate_deformation_info::reach),
          "m, of the part of the displacement that moves with the contact point.");
  state.def("deform", &deform, py::arg("deformation"), py::arg("out") = py::none(), kDeformText);
}

}  // namespace palpate::python
