// SPDX-License-Identifier: Apache-2.0
// palpate.Body: body.h5.
#include "format/body.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>

#include "python/arrays.hpp"
#include "python/artifacts.hpp"
#include "python/errors.hpp"

namespace py = pybind11;

namespace palpate::python {
namespace {

Body body_of(const std::filesystem::path& path) {
  return read_file(path, "a body (body.h5)",
                   [](const auto& file) { return palpate::read_body(file); });
}

template <class Row>
auto of_response(std::vector<Row> ResponseSurface::*member) {
  return [member](const py::object& self) {
    return view(self, self.cast<const Body&>().response.*member);
  };
}

std::string body_text(const Body& body) {
  return "<palpate.Body '" + body.name + "': " + std::to_string(body.nodes.size()) + " nodes, " +
         std::to_string(body.tetrahedra.size()) + " tetrahedra, " +
         std::to_string(body.response.node.size()) + " response vertices>";
}

}  // namespace

void define_body(py::module_& module) {
  py::class_<Body>(
      module, "Body",
      "The tetrahedralized body, body.h5; made by read_body. Arrays are read-only views.")
      .def_readonly("name", &Body::name, "Name of the case.")
      .def_property_readonly("nodes", array_of(&Body::nodes), "(N, 3) float64, m.")
      .def_property_readonly("tetrahedra", array_of(&Body::tetrahedra),
                             "(T, 4) int32, rows of nodes, of positive volume.")
      .def_property_readonly("tetrahedron_region", array_of(&Body::tetrahedron_region),
                             "(T,) int32, index into region_names.")
      .def_readonly("region_names", &Body::region_names,
                    "Names of the regions; the first is the matrix.")
      .def_property_readonly(
          "boundary", array_of(&Body::boundary),
          "(B, 3) int32, rows of nodes: the facets of the skin, counter-clockwise from outside.")
      .def_property_readonly("fixed_nodes", array_of(&Body::fixed_nodes),
                             "(F,) int32, nodes without displacement.")
      .def_property_readonly(
          "curved_edges", column_of<Body>(&Body::curved_edges, &CurvedEdge::ends),
          "(E, 2) int32, rows of nodes: edges whose middle is not halfway; none: flat facets.")
      .def_property_readonly("curved_edge_middles",
                             column_of<Body>(&Body::curved_edges, &CurvedEdge::middle),
                             "(E, 3) float64, m: their middles.")
      .def_property_readonly("foundation", column_of<Body>(&Body::foundation, &SprungFacet::facet),
                             "(S,) int32, rows of boundary: facets on springs.")
      .def_property_readonly("foundation_normal_stiffness",
                             column_of<Body>(&Body::foundation, &SprungFacet::normal_stiffness),
                             "(S,) float64, N/m^3.")
      .def_property_readonly("foundation_tangential_stiffness",
                             column_of<Body>(&Body::foundation, &SprungFacet::tangential_stiffness),
                             "(S,) float64, N/m^3.")
      .def_property_readonly("response_nodes", of_response(&ResponseSurface::node),
                             "(V,) int32, row of nodes of each response vertex.")
      .def_property_readonly("response_normals", of_response(&ResponseSurface::inward),
                             "(V, 3) float64, unit directions INTO the body.")
      .def_property_readonly("response_triangles", of_response(&ResponseSurface::triangles),
                             "(M, 3) int32, response vertices, counter-clockwise from outside.")
      .def_property_readonly("is_site", of_response(&ResponseSurface::is_site),
                             "(V,) uint8, 1 where the tool may be pressed.")
      .def_property_readonly(
          "provenance",
          [](const py::object& self) {
            return references(self, self.cast<const Body&>().provenance.steps);
          },
          kProvenanceText)
      .def("__repr__", &body_text);
  module.def(
      "read_body", &body_of, py::arg("path"),
      "read_body(path) -> Body\n\nReads and checks body.h5. Raises FileError or FormatError.");
}

}  // namespace palpate::python
