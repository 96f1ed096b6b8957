// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "format/body.hpp"
#include "mesher/geometry/surface.hpp"
#include "mesher/geometry/text.hpp"

namespace palpate::mesher {

/// Two nested triangulations of one surface.
struct NestedSurface {
  Surface response;                  ///< coarse; its points lie on the input surface
  Surface boundary;                  ///< fine; its points begin with those of `response`
  std::vector<std::int32_t> parent;  ///< response triangle of each boundary facet
  std::vector<CurvedEdge> curved;    ///< of `boundary`, their middles on the input surface
};

struct RemeshSettings {
  double spacing = 0;        ///< m, edge length of the response surface
  int subdivisions = 1;      ///< n: each response triangle becomes n x n boundary facets
  double feature_angle = 0;  ///< rad; sharper edges of the input stay sharp
  bool curved = false;       ///< put the middles of boundary edges on the input surface
  /// Sets of edges of the input that edges are to follow like sharp ones, but where they run close
  /// beside such or are shorter than three spacings.
  std::vector<std::vector<Edge>> outlines = {};
};

/// Remeshes `input` isotropically to the spacing, preserves its sharp edges, and subdivides each
/// triangle. The new vertices and the middles of curved edges are projected onto the input surface,
/// those of sharp edges onto the sharp edges.
/// @throws Error(Geometry) when the result has inverted facets or self-intersects, that is, when
///   the spacing is too coarse.
NestedSurface remesh(const Surface& input, const RemeshSettings& settings, const std::string& where,
                     const Log& log);

/// @throws Error(Geometry) with `where` when a boundary facet faces another way than its patch, or
///   when one of the surfaces intersects itself.
void check_nesting(const NestedSurface& nested, double spacing, const std::string& where);

}  // namespace palpate::mesher
