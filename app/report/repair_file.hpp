// SPDX-License-Identifier: AGPL-3.0-or-later
// repair.json: the surface of a file beside what its repair made of it, for the report.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "format/provenance.hpp"
#include "format/vec3.hpp"

namespace palpate::report {

/// A surface with the distance of each point from another one.
struct DistanceMap {
  std::vector<Vec3> points;  ///< m
  std::vector<Triangle> triangles;
  std::vector<double> distance;  ///< m
};

/// The text of repair.json.
/// @param surface_sha256 of the file of the surface
std::string repair_text(const std::string& surface_sha256, const DistanceMap& file,
                        const DistanceMap& repaired);

/// What the page draws: null without a text; {"other_surface": true} when the body was made of
/// another file.
/// @throws Error(Configuration) when the text is not a repair.json.
nlohmann::json repair_data(const std::string& text, const Provenance& body);

/// The repaired surface with its distance from the file; none without a text or where the body was
/// made of another file.
/// @throws Error(Configuration) when the text is not a repair.json.
std::optional<DistanceMap> repaired_surface(const std::string& text, const Provenance& body);

}  // namespace palpate::report
