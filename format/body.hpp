// SPDX-License-Identifier: Apache-2.0
// body.h5: the tetrahedralized body. Normative page: format/schema/body.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "format/provenance.hpp"
#include "format/vec3.hpp"

namespace palpate {

inline constexpr int kBodySchema = 1;
inline constexpr int kSprungBodySchema = 2;    ///< of a body with a foundation
inline constexpr int kCurvedBodySchema = 3;    ///< of a body with curved edges, with or without one
inline constexpr int kMeasuredBodySchema = 4;  ///< of a measured surface, whose inside is unknown

/// The coarse triangulation that carries the stored responses. Its vertices are nodes of the body.
struct ResponseSurface {
  std::vector<std::int32_t> node;     ///< (V) index into Body::nodes of each response vertex
  std::vector<Vec3> inward;           ///< (V) unit direction u^z, into the body
  std::vector<Triangle> triangles;    ///< (M) indices into `node`; counter-clockwise from outside
  std::vector<std::uint8_t> is_site;  ///< (V) 1 where the tool may be pressed: not in a support
};

/// A boundary facet on springs, slack at rest: stress on the body -k u, N/m^3 along the normal of
/// the facet at rest and across it.
struct SprungFacet {
  std::int32_t facet = 0;  ///< index into Body::boundary
  double normal_stiffness = 0;
  double tangential_stiffness = 0;
  bool operator==(const SprungFacet&) const = default;
};

/// An edge of the boundary whose middle is not halfway between its ends: along the edge the skin is
/// the parabola through the three. The skin of a facet is the quadratic in its volume coordinates
/// through its corners and the middles of its edges.
struct CurvedEdge {
  Edge ends{};    ///< indices into Body::nodes, ascending
  Vec3 middle{};  ///< m
  bool operator==(const CurvedEdge&) const = default;
};
/// A middle may lie this far from halfway between the ends, in parts of the length of the edge.
inline constexpr double kMostBulge = 0.25;

/// A body ready for indentation: straight-sided tetrahedra, their regions, the supports, the skin
/// that a tool meets and the response surface. Positions in metres. The boundary facets are
/// refinements of the triangles of the response surface, so every response vertex is a boundary
/// node.
///
/// A measured surface has neither tetrahedra, regions, supports nor curved edges, for its inside is
/// unknown: it can be felt, and not be solved. Its boundary is an open sheet.
struct Body {
  std::string name;
  std::vector<Vec3> nodes;                       ///< (N) m
  std::vector<Tetrahedron> tetrahedra;           ///< (T) positive volume
  std::vector<std::int32_t> tetrahedron_region;  ///< (T) index into region_names
  std::vector<std::string> region_names;         ///< region 0 is the matrix
  std::vector<Triangle> boundary;                ///< (B) boundary facets, outward orientation
  std::vector<CurvedEdge> curved_edges;          ///< ascending ends; empty: flat facets
  std::vector<std::int32_t> fixed_nodes;         ///< nodes with zero displacement, ascending
  std::vector<SprungFacet> foundation;           ///< ascending facets; empty: none
  ResponseSurface response;
  Provenance provenance;

  bool has_inside() const { return !tetrahedra.empty(); }  ///< false for a measured surface
};

/// Write under a temporary name and rename, so that no half-written file ever bears `path`.
/// @throws Error when the disk refuses.
void write_body(const std::filesystem::path& path, const Body& body);

/// Read and check everything: shapes, index ranges, finite numbers, unit directions, positive
/// volumes, schema version. @throws Error naming the dataset and the first offending row.
Body read_body(const std::filesystem::path& path);

/// @throws Error(Configuration) for a measured surface, which `work` cannot be done with.
void require_inside(const Body& body, const std::string& work);

}  // namespace palpate
