// SPDX-License-Identifier: Apache-2.0
// The displacement of the skin at chosen states of one site: what a campaign leaves for
// deformation.pdef. Normative page: format/schema/deformation.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "format/vec3.hpp"

namespace palpate {

/// The skin at one depth of the normal path.
struct NormalField {
  double depth = 0;         ///< m
  std::vector<float> skin;  ///< (3 W) m, displacement since before the touch
};

/// The skin at a state of a lateral path, less the skin at its start.
struct LateralField {
  double depth = 0;         ///< m, at which the path runs
  Vec3 direction{};         ///< unit
  double travel = 0;        ///< m, > 0
  std::vector<float> skin;  ///< (3 W) m
};

struct SiteFields {
  std::int32_t vertex = -1;         ///< response vertex
  std::string curves;               ///< SHA-256 of the curves of the same solution, see site_bytes
  std::vector<NormalField> normal;  ///< ascending depth
  std::vector<LateralField> lateral;  ///< in the order of the paths
};

/// The file of a site in a folder of fields.
std::filesystem::path fields_file(const std::filesystem::path& folder, std::int32_t vertex);

/// Never half written. @throws Error when the disk refuses.
void write_site_fields(const std::filesystem::path& file, const SiteFields& fields);

/// @throws Error(Configuration) where the file is missing, damaged, of another kind, or not finite.
SiteFields read_site_fields(const std::filesystem::path& file);

}  // namespace palpate
