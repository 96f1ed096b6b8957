// SPDX-License-Identifier: Apache-2.0
// palpate.Library: response surface, responses and certificate.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "format/guarantee.hpp"
#include "python/arrays.hpp"
#include "python/artifacts.hpp"
#include "python/deformation.hpp"
#include "python/errors.hpp"
#include "python/numbers.hpp"
#include "python/objects.hpp"
#include "runtime/response_curve.hpp"

namespace py = pybind11;

namespace palpate::python {
namespace {

using Pointer = std::shared_ptr<LibraryObject>;

Pointer load(const std::filesystem::path& path) {
  return read_file(path, "a library (library.h5 or library.plib)", [](const auto& file) {
    return std::make_shared<LibraryObject>(read_library(file));
  });
}

Pointer from_bytes(const py::bytes& bytes) {
  const std::string_view text = bytes;
  try {
    const py::gil_scoped_release released;
    return std::make_shared<LibraryObject>(library_from_bytes(text));
  } catch (const Error& error) {
    raise("FormatError", error);
  }
}

const NodeResponse& response(const LibraryObject& library, std::int64_t vertex) {
  const auto& responses = library.file.responses;
  if (vertex < 0 || vertex >= static_cast<std::int64_t>(responses.size())) {
    raise("ArgumentError", "Library.response: vertex " + std::to_string(vertex) +
                               " is not one of the library; give 0 to " +
                               std::to_string(responses.size() - 1));
  }
  return responses[static_cast<std::size_t>(vertex)];
}

std::string library_text(const LibraryObject& library) {
  return "<palpate.Library '" + library.file.name +
         "': " + std::to_string(library.file.positions.size()) + " vertices, " +
         std::to_string(library.file.triangles.size()) + " triangles, " +
         (library.handle.certified
              ? "certified for " + lipschitz_bound_text(library.handle.lipschitz_bound)
              : std::string("no certificate")) +
         ">";
}

/// f(d) for an array of deflections of any shape.
py::object forces_of(const ResponseCurve& curve, const py::object& deflections) {
  const runtime::CompiledCurve compiled =
      curve.knot.empty() ? runtime::CompiledCurve() : runtime::CompiledCurve(curve);
  return py::vectorize([&compiled](double d) { return compiled.force(d); })(
      doubles_of(deflections, "ResponseCurve: deflections"));
}

void define_responses(py::module_& module) {
  py::class_<ResponseCurve>(
      module, "ResponseCurve",
      "A force-deflection curve f(d), piecewise quadratic with continuous slope; beyond the\n"
      "last knot it continues in a straight line. Empty where there is no response.")
      .def_property_readonly("knots", array_of(&ResponseCurve::knot),
                             "(K,) float32, m, from 0 and increasing; read-only view.")
      .def_property_readonly(
          "slopes", array_of(&ResponseCurve::slope),
          "(K,) float32, N/m, f' at the knots, linear between them; read-only view.")
      .def("__call__", &forces_of, py::arg("deflections"),
           "curve(deflections) -> forces\n\n"
           "f(d) in N at deflections in m, an array of any shape, as the runtime evaluates it; 0 "
           "for d <= 0.")
      .def("__len__", [](const ResponseCurve& curve) { return curve.knot.size(); });
  py::class_<NodeResponse>(module, "Response", "The responses of a vertex of a library.")
      .def_property_readonly(
          "status", [](const NodeResponse& node) { return static_cast<int>(node.status); },
          "0: fitted to curves of this vertex, 1: interpolated from its neighbours, 2: a hole "
          "without response.")
      .def_readonly("normal", &NodeResponse::normal,
                    "f^z: force along the inward normal, of the depth.")
      .def_readonly("lateral", &NodeResponse::lateral,
                    "f^r: force across it, of the lateral deflection.")
      .def_property_readonly(
          "coupling",
          [](const NodeResponse& node) -> const ResponseCurve& { return node.coupling.curve; },
          "w - coupling_base, of the depth in m, without unit: the lateral force is w(z) f^r(rho). "
          "Empty where\n"
          "the responses are decoupled.")
      .def_property_readonly(
          "coupling_base", [](const NodeResponse& node) { return node.coupling.base; },
          "w(0), without unit.")
      .def_property_readonly(
          "relaxation", array_of(&NodeResponse::relaxation),
          "(B,) float32: fraction of the normal response that relaxes with each of\n"
          "Library.relaxation_times.")
      .def_property_readonly(
          "lean", [](const NodeResponse& node) { return py::array_t<float>(3, node.lean.data()); },
          "(3,) float32, without unit: lateral deflection of a straight press over its depth,\n"
          "across the press direction; of coupled responses where w is 1, as it grows with w.\n"
          "Zero where a press does not lean.")
      .def_property_readonly(
          "soft_axis",
          [](const NodeResponse& node) { return py::array_t<float>(3, node.soft_axis.data()); },
          "(3,) float32, without unit: along b the lateral stiffness is (1 - |b|^2)^2 of that "
          "across\n"
          "b. Its sign means nothing. Zero where it is the same in all lateral directions.")
      .def_readonly("normal_error", &NodeResponse::normal_error,
                    "N, largest |fit - sample| of f^z.")
      .def_readonly("lateral_error", &NodeResponse::lateral_error, "N, the same of f^r.");
}

void define_certificate(py::module_& module) {
  py::class_<DeviceCertificate>(module, "DeviceCertificate",
                                "What a haptic device can render of a library. NaN: not known.")
      .def_readonly("device", &DeviceCertificate::device, "Name of the device profile.")
      .def_readonly("damping", &DeviceCertificate::damping, "N s/m, smallest viscous damping.")
      .def_readonly("coulomb_friction", &DeviceCertificate::coulomb_friction,
                    "N, smallest dry friction.")
      .def_readonly("delay", &DeviceCertificate::delay, "s, beyond one sample of the loop.")
      .def_readonly("position_resolution", &DeviceCertificate::position_resolution, "m.")
      .def_readonly("force_resolution", &DeviceCertificate::force_resolution, "N.")
      .def_readonly(
          "lowest_rate", &DeviceCertificate::lowest_rate,
          "Hz: rate of the force loop from which its damping suffices; infinite: no rate.")
      .def_readonly("published_rate", &DeviceCertificate::published_rate,
                    "Hz: the rate of Mahvash and Hayward 2005, eq. 5.");
  py::class_<Certificate>(
      module, "Certificate",
      "Bounds of the force of a library, on which the passivity of the force loop rests.")
      .def_readonly("friction", &Certificate::friction, "Friction coefficient of the certificate.")
      .def_readonly("depth", &Certificate::depth, "m, deepest depth for which the bounds hold.")
      .def_readonly("stick", &Certificate::stick, "N/m, L_stick: bound with a fixed contact point.")
      .def_readonly("slip", &Certificate::slip,
                    "N/m, L_slip: bound while sliding; may be infinite.")
      .def_readonly("min_lipschitz_bound", &Certificate::min_lipschitz_bound,
                    "N/m, smallest bound that the runtime can enforce; NaN: not known.")
      .def_property_readonly(
          "lipschitz_bound", &enforced_lipschitz_bound,
          "N/m, bound that the runtime enforces by default; infinite without a certificate.")
      .def_readonly("limited_by", &Certificate::limited_by,
                    "What sets the bound in the worst triangle.")
      .def_readonly("basis", &Certificate::basis,
                    "What the responses are made of: \"simulated\", ...")
      .def_readonly("holes", &Certificate::holes, "Vertices without a response.")
      .def_readonly("interpolated", &Certificate::interpolated,
                    "Vertices with a response of their neighbours.")
      .def_readonly("relaxation_rate", &Certificate::relaxation_rate,
                    "1/s; 0 where nothing relaxes.")
      .def_readonly("devices", &Certificate::devices,
                    "A list with one DeviceCertificate for each device.")
      .def_property_readonly("guarantee", &guarantee_text,
                             "What is guaranteed of the force, one line.")
      .def(
          "verdict",
          [](const Certificate& self, const DeviceCertificate& device) {
            return verdict(self, device);
          },
          py::arg("device"),
          "verdict(device) -> str\n\nOne line on one of `devices`: from which rate it is certified "
          "passive, or why not.")
      .def(
          "certifies",
          [](const Certificate& self, const DeviceCertificate& device) {
            return is_certified(self, device);
          },
          py::arg("device"),
          "certifies(device) -> bool\n\nWhether one of `devices` is certified passive from its "
          "lowest_rate on.");
}

template <class Value>
auto of_file(Value Library::*member) {
  return [member](const LibraryObject& library) -> const Value& { return library.file.*member; };
}

template <class Value>
auto of_info(Value palpate_library_info::*member) {
  return [member](const LibraryObject& library) { return library.handle.info.*member; };
}

template <class Row>
auto array_of_file(std::vector<Row> Library::*member) {
  return [member](const py::object& self) {
    return view(self, self.cast<const LibraryObject&>().file.*member);
  };
}

void define_geometry(py::class_<LibraryObject, Pointer>& library) {
  library
      .def_property_readonly("vertices", array_of_file(&Library::positions),
                             "(V, 3) float64, m: vertices of the response surface; read-only view.")
      .def_property_readonly(
          "normals", array_of_file(&Library::inward),
          "(V, 3) float64: unit directions INTO the body, along which f^z acts; read-only view.")
      .def_property_readonly("triangles", array_of_file(&Library::triangles),
                             "(M, 3) int32: vertices of each triangle, counter-clockwise from "
                             "outside; read-only view.")
      .def_property_readonly(
          "vertex_status",
          [](const py::object& self) {
            return view(self, self.cast<const LibraryObject&>().handle.statuses);
          },
          "(V,) uint8: 0 fitted, 1 interpolated, 2 hole (cannot be touched); read-only view.")
      .def_property_readonly(
          "low",
          [](const py::object& self) {
            return view_of_row(self, self.cast<const LibraryObject&>().handle.info.low);
          },
          "(3,) float64, m: lower corner of the bounding box.")
      .def_property_readonly(
          "high",
          [](const py::object& self) {
            return view_of_row(self, self.cast<const LibraryObject&>().handle.info.high);
          },
          "(3,) float64, m: upper corner of the bounding box.");
}

void define_info(py::class_<LibraryObject, Pointer>& library) {
  library.def_property_readonly("name", of_file(&Library::name), "Name of the body.")
      .def_property_readonly("tool_shape", of_file(&Library::tool_shape),
                             "\"sphere\", \"disc\" or \"cylinder\".")
      .def_property_readonly("tool_radius", of_file(&Library::tool_radius), "m.")
      .def_property_readonly(
          "coupled",
          [](const LibraryObject& self) { return self.file.kind == ResponseKind::Coupled; },
          "Whether lateral responses grow with depth.")
      .def_property_readonly("relaxation_times", array_of_file(&Library::relaxation_times),
                             "(B,) float64, s, increasing; empty where the responses are elastic.")
      .def_property_readonly("depth", of_info(&palpate_library_info::depth), "m, deepest sample.")
      .def_property_readonly("friction", of_info(&palpate_library_info::friction),
                             "Friction coefficient of the certificate.")
      .def_property_readonly("stick", of_info(&palpate_library_info::stick),
                             "N/m, L_stick; 0 without a certificate.")
      .def_property_readonly("slip", of_info(&palpate_library_info::slip),
                             "N/m, L_slip; 0 without a certificate.")
      .def_property_readonly(
          "min_lipschitz_bound", of_info(&palpate_library_info::min_lipschitz_bound),
          "N/m, smallest enforceable lipschitz_bound of a state; NaN: not known.")
      .def_property_readonly("lipschitz_bound", of_info(&palpate_library_info::lipschitz_bound),
                             "N/m, enforced by default; infinite without a certificate.")
      .def_property_readonly("certificate", of_file(&Library::certificate), "The Certificate.")
      .def_property_readonly(
          "provenance",
          [](const py::object& self) {
            return references(self, self.cast<const LibraryObject&>().file.provenance.steps);
          },
          kProvenanceText)
      .def_property_readonly(
          "certified", [](const LibraryObject& self) { return self.handle.certified; },
          "Whether the library has a certificate.");
}

constexpr const char* kLibraryText =
    "Library(path)\n\n"
    "A response library: library.h5, or a flat library.plib.\n\n"
    "It is immutable and may be shared by threads. Its arrays are read-only views of its memory, "
    "which they keep.\n"
    "Raises FileError where the file cannot be opened, FormatError where it is not a valid "
    "library.";

constexpr const char* kStateOfText =
    "state(*, friction=None, tank_cap=0.005, lipschitz_bound=None, search_rate=0) -> State\n\n"
    "One tool on this body. friction: coefficient, None: that of the certificate; tank_cap: J, of "
    "the energy tank;\n"
    "lipschitz_bound: N/m, at least min_lipschitz_bound, None: that of the library; search_rate: "
    "Hz, of a thread that\n"
    "finds triangles, 0: each step searches the whole body, and the forces repeat to the bit.\n"
    "Raises ArgumentError for a value out of range, and without friction where the library has no "
    "certificate.";

}  // namespace

void define_library(py::module_& module) {
  define_responses(module);
  define_certificate(module);
  py::class_<LibraryObject, Pointer> library(module, "Library", kLibraryText);
  library.def(py::init(&load), py::arg("path"))
      .def_static("from_bytes", &from_bytes, py::arg("bytes"),
                  "from_bytes(bytes) -> Library\n\nA library from the bytes of its file.")
      .def("response", &response, py::arg("vertex"), py::return_value_policy::reference_internal,
           "response(vertex) -> Response\n\nThe responses of a vertex. Raises ArgumentError where "
           "there is no such vertex.")
      .def("state", &make_state, py::kw_only(), py::arg("friction") = py::none(),
           py::arg("tank_cap") = 5e-3, py::arg("lipschitz_bound") = py::none(),
           py::arg("search_rate") = 0.0, kStateOfText)
      .def("deformation", &load_deformation, py::arg("path"),
           "deformation(path) -> Deformation\n\n"
           "deformation.pdef, which lies beside the library where the case asks for it. Raises "
           "FileError, FormatError, or\n"
           "MismatchError where it was made with another library.")
      .def("__repr__", &library_text);
  define_geometry(library);
  define_info(library);
}

}  // namespace palpate::python
