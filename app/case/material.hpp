// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "app/case/case.hpp"

namespace palpate::app {

/// The keys of a [[material]] table that declare a law without fibres, as TOML: the parsed table
/// has the same law, to the last digit.
std::string material_keys(const fem::LawConstants& law);

/// Whether the law of the material has fibres whose directions come from a file.
bool reads_fibre_file(const MaterialSection& material);

/// The material of a campaign: with its instantaneous law, and with the fibre directions of its
/// file, if it has one; `folder`: that of the case.
/// @throws Error(Configuration) as fem::instantaneous_law and read_fibre_file.
fem::RegionMaterial campaign_material(const MaterialSection& material,
                                      const std::filesystem::path& folder);

}  // namespace palpate::app
