// SPDX-License-Identifier: AGPL-3.0-or-later
// A first case whose sites were counted on its body.
#pragma once

#include <filesystem>
#include <string>

#include "app/init/base.hpp"
#include "app/init/body_file.hpp"
#include "app/init/first_case.hpp"

namespace palpate::app {

/// The first case of a body with patches that make about `wanted` sites as the mesher counts them:
/// the area alone does not say how many, because Delaunay refinement divides what is curved, and
/// because supports and cavities take sites away. Meshes the body a few times. Where the mesher
/// refuses it, the sizes follow from the area, and a remark says why it was refused.
/// @param target  path of the case; nothing is written
/// @throws Error(Configuration) where the case itself would be refused
FirstCase counted_case(const BodyFile& body, const Base& base, int wanted, const std::string& name,
                       const std::filesystem::path& target);

}  // namespace palpate::app
