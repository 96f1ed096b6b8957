// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "app/case/case.hpp"
#include "fem/laws/law_table.hpp"

namespace palpate::app {

/// The law that a [[material]] table declares.
fem::LawConstants law_of(const MaterialSection& material);

/// The keys of a [[material]] table that declares a law without fibres, as TOML: law_of() of the
/// parsed table is the same law, to the last digit.
std::string material_keys(const fem::LawConstants& law);

/// With the directions of the fibres that a file holds; `folder`: that of the case file.
/// @throws Error(Configuration) as read_fibre_file.
fem::LawConstants law_of(const MaterialSection& material, const std::filesystem::path& folder);

/// Whether the second of these reads a file.
bool reads_fibre_file(const MaterialSection& material);

}  // namespace palpate::app
