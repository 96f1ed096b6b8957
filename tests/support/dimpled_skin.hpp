// SPDX-License-Identifier: AGPL-3.0-or-later
// A deformation of closed form for any library and skin: a dimple that follows the contact, and
// waves over the whole skin, so that every part of a deformation has its work.
#pragma once

#include "format/deformation.hpp"
#include "format/library.hpp"
#include "format/skin_mesh.hpp"

namespace palpate::test {

/// The skin of a library alone: its response surface.
SkinMesh skin_of(const Library& library);

/// Each vertex with a response is a site. `depth`: m, of the deepest stored press; the tool is a
/// sphere.
Deformation dimpled(const Library& library, const SkinMesh& skin, double depth, double tool_radius);

}  // namespace palpate::test
