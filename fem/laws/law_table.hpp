// SPDX-License-Identifier: AGPL-3.0-or-later
// The laws by name: their constants with ranges and sources, and a law made of constants. The case
// file, its reference page and the exports are made from this table.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fem/laws/fibre_field.hpp"

namespace palpate::fem {

class Law;

/// A constant of a law. An open end of the range is excluded; so are values that are not finite.
struct LawConstant {
  std::string_view name;
  std::string_view about;
  bool is_stress = false;  ///< in Pa; otherwise a pure number
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = true, high_open = true;

  bool holds(double value) const {
    return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
  }
};

struct LawEntry {
  std::string_view name;
  std::string_view formula;  ///< W of the isochoric deformation, or Psi
  std::string_view source;
  bool has_fibres;
  std::vector<LawConstant> constants;
};

std::span<const LawEntry> law_table();
/// @throws Error(Configuration) for a name that is not in the table.
const LawEntry& law_entry(std::string_view name);
/// @throws Error(Configuration) for a law or a constant that is not in the table.
const LawConstant& law_constant(std::string_view law, std::string_view name);

/// A law and the values of its constants.
struct LawConstants {
  LawConstants() = default;
  /// Neo-Hookean by its small-strain constants, Pa and pure.
  LawConstants(double young, double poisson);
  LawConstants(std::string name, std::vector<std::pair<std::string, double>> constants,
               FibreField fibre_field = {})
      : law(std::move(name)), values(std::move(constants)), fibres(std::move(fibre_field)) {}

  std::string law = "neo-hookean";
  std::vector<std::pair<std::string, double>> values;  ///< by name, SI
  FibreField fibres;                                   ///< of laws that have them

  /// @throws Error(Configuration) when the law has no such constant or it is not given.
  double at(std::string_view name) const;
  double& at(std::string_view name);

  bool operator==(const LawConstants&) const = default;
};

/// Moduli of the body at rest, as of an isotropic solid: fibres are slack there.
struct RestModuli {
  double young, poisson;
  double mu() const { return young / (2 * (1 + poisson)); }
  double kappa() const { return young / (3 * (1 - 2 * poisson)); }
};
RestModuli rest_moduli(const LawConstants& constants);

/// @throws Error(Configuration) for an unknown law, a constant that is missing, unknown, not finite
/// or out of range (named, with value and range); `where` names the owner of the constants.
void check_law(const LawConstants& constants, const std::string& where);

/// @throws Error(Configuration) as check_law.
Law make_law(const LawConstants& constants, const std::string& where);

/// The same without any check of the ranges: for derivatives by a constant at the end of its range.
Law unchecked_law(const LawConstants& constants);

}  // namespace palpate::fem
