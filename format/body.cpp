// SPDX-License-Identifier: Apache-2.0
#include "format/body.hpp"

#include <algorithm>

#include "format/artifact.hpp"
#include "format/edge.hpp"
#include "format/error.hpp"

namespace palpate {
namespace {

constexpr const char* kBodyArtifact = "palpate.body";
constexpr const char* kBodyRemedy = "make it again with 'palpate mesh'";

double volume_of(const std::vector<Vec3>& nodes, const Tetrahedron& corners) {
  const auto at = [&](std::size_t i) { return nodes[static_cast<std::size_t>(corners[i])]; };
  return dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) / 6;
}

/// What only a body with an inside has.
void check_measured(const Checks& checks, const Body& body) {
  checks.require(!body.boundary.empty(), "/boundary", "is empty");
  checks.same_size("/tetrahedron_region", body.tetrahedron_region.size(), 0);
  checks.same_size("/region_names", body.region_names.size(), 0);
  checks.same_size("/fixed_nodes", body.fixed_nodes.size(), 0);
  checks.same_size("/foundation/facet", body.foundation.size(), 0);
  checks.same_size("/curved_edges/ends", body.curved_edges.size(), 0);
}

void check_tetrahedra(const Checks& checks, const Body& body) {
  checks.corners("/tetrahedra", body.tetrahedra, body.nodes.size());
  for (std::size_t row = 0; row < body.tetrahedra.size(); ++row) {
    const double volume = volume_of(body.nodes, body.tetrahedra[row]);
    if (!(volume > 0)) {
      checks.fail_geometry("/tetrahedra", row, "is inverted or flat: its volume is not positive");
    }
  }
  checks.require(!body.region_names.empty(), "/region_names", "is empty");
  checks.same_size("/tetrahedron_region", body.tetrahedron_region.size(), body.tetrahedra.size());
  checks.indices("/tetrahedron_region", body.tetrahedron_region, body.region_names.size());
}

void check_curved_edges(const Checks& checks, const Body& body) {
  const std::vector<Edge> edges = edges_of(body.boundary);
  for (std::size_t row = 0; row < body.curved_edges.size(); ++row) {
    const auto& [ends, middle] = body.curved_edges[row];
    if (!std::binary_search(edges.begin(), edges.end(), ends)) {
      checks.fail_row("/curved_edges/ends", row,
                      "is not an edge of the boundary, lower node first");
    }
    if (row > 0 && !(body.curved_edges[row - 1].ends < ends)) {
      checks.fail_row("/curved_edges/ends", row, "is not above the row before it");
    }
    checks.vector("/curved_edges/middle", row, middle, rules::kFinite);
    const Vec3 a = body.nodes[static_cast<std::size_t>(ends[0])];
    const Vec3 b = body.nodes[static_cast<std::size_t>(ends[1])];
    if (!(norm(middle - 0.5 * (a + b)) <= kMostBulge * norm(b - a))) {
      checks.fail_row("/curved_edges/middle", row,
                      "is farther from the edge than a quarter of its length");
    }
  }
}

void check_fixed_nodes(const Checks& checks, const Body& body) {
  checks.indices("/fixed_nodes", body.fixed_nodes, body.nodes.size());
  for (std::size_t row = 1; row < body.fixed_nodes.size(); ++row) {
    if (body.fixed_nodes[row] <= body.fixed_nodes[row - 1]) {
      checks.fail_row("/fixed_nodes", row, "is not above the row before it");
    }
  }
}

void check_foundation(const Checks& checks, const Body& body) {
  for (std::size_t row = 0; row < body.foundation.size(); ++row) {
    const SprungFacet& sprung = body.foundation[row];
    checks.index("/foundation/facet", row, sprung.facet, body.boundary.size());
    if (row > 0 && sprung.facet <= body.foundation[row - 1].facet) {
      checks.fail_row("/foundation/facet", row, "is not above the row before it");
    }
    checks.number("/foundation/normal_stiffness", row, sprung.normal_stiffness,
                  rules::kNonNegative);
    checks.number("/foundation/tangential_stiffness", row, sprung.tangential_stiffness,
                  rules::kNonNegative);
  }
}

void check_response(const Checks& checks, const Body& body) {
  const ResponseSurface& surface = body.response;
  checks.indices("/response/node", surface.node, body.nodes.size());
  std::vector<std::uint8_t> on_boundary(body.nodes.size(), 0);
  for (const Triangle& facet : body.boundary) {
    for (const std::int32_t node : facet) on_boundary[static_cast<std::size_t>(node)] = 1;
  }
  for (std::size_t row = 0; row < surface.node.size(); ++row) {
    std::uint8_t& mark = on_boundary[static_cast<std::size_t>(surface.node[row])];
    if (mark == 0) checks.fail_row("/response/node", row, "is not a corner of a boundary facet");
    if (mark == 2) checks.fail_row("/response/node", row, "names a node twice");
    mark = 2;
  }
  checks.same_size("/response/inward", surface.inward.size(), surface.node.size());
  checks.vectors("/response/inward", surface.inward, rules::kUnit);
  checks.corners("/response/triangles", surface.triangles, surface.node.size());
  checks.same_size("/response/is_site", surface.is_site.size(), surface.node.size());
  checks.numbers("/response/is_site", surface.is_site, rules::kFlag);
}

void check_body(const Checks& checks, const Body& body) {
  checks.vectors("/nodes", body.nodes, rules::kFinite);
  if (body.has_inside()) {
    check_tetrahedra(checks, body);
  } else {
    check_measured(checks, body);
  }
  checks.corners("/boundary", body.boundary, body.nodes.size());
  check_curved_edges(checks, body);
  check_fixed_nodes(checks, body);
  check_foundation(checks, body);
  check_response(checks, body);
  check_provenance(checks, body.provenance);
}

void write_foundation(hdf5::Writer& writer, const std::vector<SprungFacet>& foundation) {
  std::vector<std::int32_t> facet;
  std::vector<double> normal, tangential;
  for (const SprungFacet& sprung : foundation) {
    facet.push_back(sprung.facet);
    normal.push_back(sprung.normal_stiffness);
    tangential.push_back(sprung.tangential_stiffness);
  }
  writer.group("/foundation", "Boundary facets that rest on springs.");
  writer.dataset("/foundation/facet", facet, {"1", "Row of /boundary, ascending."});
  writer.dataset("/foundation/normal_stiffness", normal,
                 {"N/m^3", "Springs per area along the normal of the facet at rest."});
  writer.dataset("/foundation/tangential_stiffness", tangential,
                 {"N/m^3", "Springs per area across that normal."});
}

std::vector<SprungFacet> read_foundation(hdf5::Reader& reader) {
  const auto facet = reader.dataset<std::int32_t>("/foundation/facet", "1");
  const auto normal = reader.dataset<double>("/foundation/normal_stiffness", "N/m^3");
  const auto tangential = reader.dataset<double>("/foundation/tangential_stiffness", "N/m^3");
  const Checks checks(reader);
  checks.same_size("/foundation/normal_stiffness", normal.size(), facet.size());
  checks.same_size("/foundation/tangential_stiffness", tangential.size(), facet.size());
  std::vector<SprungFacet> foundation;
  for (std::size_t row = 0; row < facet.size(); ++row) {
    foundation.push_back({facet[row], normal[row], tangential[row]});
  }
  return foundation;
}

void write_curved_edges(hdf5::Writer& writer, const std::vector<CurvedEdge>& curved) {
  std::vector<Edge> ends;
  std::vector<Vec3> middle;
  for (const CurvedEdge& edge : curved) {
    ends.push_back(edge.ends);
    middle.push_back(edge.middle);
  }
  writer.group("/curved_edges", "Edges of the boundary that follow a curved skin.");
  writer.dataset("/curved_edges/ends", ends, {"1", "Rows of /nodes, ascending."});
  writer.dataset("/curved_edges/middle", middle,
                 {"m", "Where the skin is, halfway between the ends of each edge."});
}

std::vector<CurvedEdge> read_curved_edges(hdf5::Reader& reader) {
  const auto ends = reader.dataset<Edge>("/curved_edges/ends", "1");
  const auto middle = reader.dataset<Vec3>("/curved_edges/middle", "m", ends.size());
  std::vector<CurvedEdge> curved;
  for (std::size_t row = 0; row < ends.size(); ++row) curved.push_back({ends[row], middle[row]});
  return curved;
}

/// The lowest schema whose readers know all that the body has.
int schema_of(const Body& body) {
  if (!body.has_inside()) return kMeasuredBodySchema;
  if (!body.curved_edges.empty()) return kCurvedBodySchema;
  return body.foundation.empty() ? kBodySchema : kSprungBodySchema;
}

void write_response(hdf5::Writer& writer, const ResponseSurface& surface) {
  writer.group("/response", "The coarse triangulation that carries the responses.");
  writer.dataset("/response/node", surface.node,
                 {"1", "Node of the body at each response vertex."});
  writer.dataset("/response/inward", surface.inward,
                 {"1", "Unit direction u^z at each response vertex, into the body."});
  writer.dataset("/response/triangles", surface.triangles,
                 {"1", "Response vertices of each triangle, counter-clockwise seen from outside."});
  writer.dataset("/response/is_site", surface.is_site,
                 {"1", "1 where the tool may be pressed, 0 in a support or on springs."});
}

}  // namespace

void write_body(const std::filesystem::path& path, const Body& body) {
  check_body(Checks(path), body);
  hdf5::Writer writer(path);
  write_root(writer, kBodyArtifact, schema_of(body),
             body.has_inside() ? "A tetrahedralized body, ready for indentation."
                               : "A measured surface, whose inside is unknown.");
  writer.set_text("/", "name", body.name);
  writer.dataset("/nodes", body.nodes, {"m", "Reference position X of each node."});
  writer.dataset("/tetrahedra", body.tetrahedra,
                 {"1", "Nodes of each tetrahedron, of positive volume."});
  writer.dataset("/tetrahedron_region", body.tetrahedron_region,
                 {"1", "Region of each tetrahedron, a row of /region_names."});
  writer.texts("/region_names", body.region_names,
               "Name of each material region; region 0 is the matrix.");
  writer.dataset("/boundary", body.boundary,
                 {"1", "Nodes of each boundary facet, counter-clockwise seen from outside."});
  writer.dataset("/fixed_nodes", body.fixed_nodes,
                 {"1", "Nodes with zero displacement, ascending."});
  if (!body.curved_edges.empty()) write_curved_edges(writer, body.curved_edges);
  if (!body.foundation.empty()) write_foundation(writer, body.foundation);
  write_response(writer, body.response);
  write_provenance(writer, body.provenance);
  writer.commit();
}

Body read_body(const std::filesystem::path& path) {
  hdf5::Reader reader(path, kBodyRemedy);
  const auto schema = reader.require_artifact(
      kBodyArtifact, {kBodySchema, kSprungBodySchema, kCurvedBodySchema, kMeasuredBodySchema});
  Body body;
  body.name = reader.text("/", "name");
  body.nodes = reader.dataset<Vec3>("/nodes", "m");
  body.tetrahedra = reader.dataset<Tetrahedron>("/tetrahedra", "1");
  body.tetrahedron_region = reader.dataset<std::int32_t>("/tetrahedron_region", "1");
  Checks(reader).require(body.tetrahedra.empty() == (schema == kMeasuredBodySchema), "/tetrahedra",
                         body.tetrahedra.empty() ? "is empty" : "is not empty");
  body.region_names = reader.texts("/region_names");
  body.boundary = reader.dataset<Triangle>("/boundary", "1");
  body.fixed_nodes = reader.dataset<std::int32_t>("/fixed_nodes", "1");
  if (schema == kCurvedBodySchema) body.curved_edges = read_curved_edges(reader);
  if (schema == kSprungBodySchema || (schema == kCurvedBodySchema && reader.has("/foundation"))) {
    body.foundation = read_foundation(reader);
  }
  body.response.node = reader.dataset<std::int32_t>("/response/node", "1");
  body.response.inward = reader.dataset<Vec3>("/response/inward", "1");
  body.response.triangles = reader.dataset<Triangle>("/response/triangles", "1");
  body.response.is_site = reader.dataset<std::uint8_t>("/response/is_site", "1");
  body.provenance = read_provenance(reader);
  check_body(Checks(reader), body);
  return body;
}

void require_inside(const Body& body, const std::string& work) {
  if (body.has_inside()) return;
  refuse(work, "'" + body.name + "' is a measured surface, whose inside is unknown",
         "give a body of tetrahedra, made with `palpate mesh`");
}

}  // namespace palpate
