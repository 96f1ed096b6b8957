// SPDX-License-Identifier: AGPL-3.0-or-later
// The mesh of a body in the formats of other programs.
#pragma once

#include <string>

#include "format/body.hpp"

namespace palpate::app {

/// Texts of mesh files, in metres: the tetrahedra with their regions, and the sets of nodes
/// "fixed", "sprung" (of facets on springs), "boundary", "response" and "sites", as far as they
/// have nodes. Tetrahedra are quadratic where the body has curved edges; other mid-nodes are
/// halfway. Each of them reads back as the same nodes (.inp: to 13 digits), tetrahedra, regions and
/// sets.
std::string gmsh_mesh(const Body& body);    ///< MSH 2.2; regions and sets are physical groups
std::string vtu_mesh(const Body& body);     ///< cell array "region", names of regions, marks
std::string abaqus_mesh(const Body& body);  ///< Abaqus and CalculiX; names of letters and digits
std::string febio_mesh(const Body& body);   ///< format 4.0: the section Mesh

/// The response surface as an OFF file, in metres; its vertices are those of the library.
std::string off_surface(const Body& body);

}  // namespace palpate::app
