// SPDX-License-Identifier: AGPL-3.0-or-later
// A first case whose sites were counted on its body.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/init/base.hpp"
#include "app/init/body_file.hpp"
#include "app/init/first_case.hpp"
#include "app/pipeline/workspace.hpp"
#include "format/body.hpp"

namespace palpate::app {

/// What the case of a body is made from, but for its sizes.
struct CaseOf {
  BodyFile body;
  Base base;
  std::string name;              ///< of the case; empty: that of its file
  std::filesystem::path target;  ///< path of the case; nothing is written

  FirstCase with(const FirstSizes& sizes) const;
  /// As that case would be opened. @throws Error(Configuration) where it would be refused
  Workspace opened_with(const FirstSizes& sizes) const;
};

struct CountedCase {
  FirstSizes sizes;
  std::optional<Body> body;  ///< as it is meshed with these sizes
  std::string refusal;       ///< why it is not meshed
};

/// Meshes the body with the sizes at hand, and counts its sites.
/// @throws Error where the mesher refuses it
void count_sites(const CaseOf& made, CountedCase& counted);

/// Patches that make about `wanted` sites as the mesher counts them: the area alone does not say
/// how many, because Delaunay refinement divides what is curved, and because supports and cavities
/// take sites away. Meshes the body a few times. Where the mesher refuses it, smaller patches are
/// tried; where it refuses these too, the sizes follow from the area.
/// @throws Error(Configuration) where the case itself would be refused
CountedCase counted_case(const CaseOf& made, int wanted);

/// "sites: 198", and where they are far from the wanted number, why.
std::string remark_on_sites(const FirstSizes& sizes, int wanted);

}  // namespace palpate::app
