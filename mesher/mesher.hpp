// SPDX-License-Identifier: AGPL-3.0-or-later
// Makes a body of surface files. CGAL and TetGen stay inside the .cpp files of this folder.
#pragma once

#include "format/body.hpp"
#include "mesher/settings.hpp"

namespace palpate::mesher {

/// Checks and remeshes the surfaces and fills them with tetrahedra.
///
/// The response surface has edges near patch_spacing.
/// Each of its triangles is divided into n x n boundary facets, n = round(patch_spacing /
/// element_size), and the new vertices are projected onto the input surface. The two surfaces are
/// nested: the facets of response triangle m are Body::boundary[m n^2 .. (m+1) n^2), and response
/// vertex v is node v.
///
/// Boundary nodes inside a support, or within 1/1000 of Settings::size_of_skin(),
/// 1/100 of it where the support is round, are fixed.
/// Response vertices are no sites when they lie within tool_radius of a fixed node or of a facet on
/// springs, or when no press direction can be interpolated around them because the surface is
/// sharper than the patches resolve; the log counts the latter.
///
/// Equal settings and files give equal bodies, to the bit. The caller adds the provenance.
/// @throws Error(Geometry) for a surface that is missing, empty, not watertight, not orientable,
///   self-intersecting, in several parts, has non-finite coordinates or an implausible size for its
///   unit (the largest dimension must lie in 10 um .. 10 m); for an inclusion that is not strictly
///   inside the skin; for supports that do not prevent rigid motion or leave no site; for detail
///   finer than the patches; for a depth of more than 0.8 of the thickness under a site; for a
///   lateral travel longer than the body; for degenerate tetrahedra.
/// @throws Error(Configuration) for settings out of range.
Body mesh(const Settings& settings);

}  // namespace palpate::mesher
