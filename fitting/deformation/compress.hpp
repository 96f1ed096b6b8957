// SPDX-License-Identifier: AGPL-3.0-or-later
// The fields of a campaign -> deformation.pdef.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "format/body.hpp"
#include "format/curves.hpp"
#include "format/deformation.hpp"
#include "format/library.hpp"
#include "format/site_fields.hpp"

namespace palpate::fitting {

struct CompressSettings {
  int modes = 200;      ///< largest number of shared modes
  double reach = 4;     ///< R_c over the radius of the tool
  double least = 1e-4;  ///< modes of a singular value below this part of the largest are left out
};

/// Separates each field into its local part and the rest, and the rest into shared modes.
/// @param vertices  sites that have fields; those whose press or lateral paths ended early are left
///   out, and their vertices interpolated as other vertices without a site
/// @param fields  reads those of one site; called twice for each vertex, ascending
/// @throws Error(Configuration) where no site has all its fields, or the fields are of another
/// body.
Deformation compress(const Body& body, const Library& library, const ToolDescription& tool,
                     const std::vector<std::int32_t>& vertices,
                     const std::function<SiteFields(std::int32_t)>& fields,
                     const CompressSettings& settings);

}  // namespace palpate::fitting
